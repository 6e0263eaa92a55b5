#include "solvers/periodic/mean_equilibrium.hpp"

#include <cmath>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr double kNoPart = 1e-9;  // ratio relative to the largest of a rigid-body motion that counts as 0 [-]

}  // namespace

MeanEquilibrium::MeanEquilibrium(const System& system, const Vector& damping, const Vector& stiffness,
                                 const std::string& balance, std::vector<Finding>& findings)
    : system_(system),
      assembler_(system),
      damping_(damping),
      elimination_(system.pattern()),
      floating_(system.floating_parts(Contact::closed)),
      z_(idx(system.size())) {
  // A floating part is held at one node, so that it can be eliminated: under balanced loads that node does
  // not move, and the hold carries no force.
  Vector held = stiffness;
  const Vector none = Vector::Zero(stiffness.size());
  std::vector<int> holds;
  std::vector<double> strength;
  for (const std::string& name : floating_) {
    const std::vector<Entry> row = system_.row_of(system_.node(name));
    const int unknown = row.empty() ? 0 : row.front().index;
    const int slot = system_.diagonal_slots()[idx(unknown)];
    holds.push_back(unknown);
    strength.push_back(stiffness[slot] > 0.0 ? stiffness[slot] : 1.0);
    held[slot] += strength.back();
  }
  if (!elimination_.factorize(none, none, held, 0.0))
    throw SolverError("sweep of " + system_.name() + ": the static stiffness is singular");
  for (std::size_t f = 0; f < floating_.size(); ++f) {
    std::vector<std::complex<double>> r(idx(system_.size()));
    r[idx(holds[f])] = strength[f];
    elimination_.solve(r.data());
    Vector shape(system_.size());
    for (int i = 0; i < system_.size(); ++i) shape[i] = r[idx(i)].real();
    const int node = system_.node(floating_[f]);
    const double moves = value_along(system_.row_of(node), shape), ratio = system_.ratio(node);
    shape *= (ratio != 0.0 ? ratio : 1.0) / moves;
    rigid_.push_back(shape);
    if (ratio == 0.0) dragged_.push_back(f);
  }
  balance_.resize(floating_.size());
  if (balance.empty()) return;
  try {
    const std::vector<Entry> row = system_.row_of(system_.node(balance));
    bool any = false;
    for (std::size_t f = 0; f < rigid_.size(); ++f)
      if (!row.empty() && std::abs(value_along(row, rigid_[f])) > kNoPart * rigid_[f].cwiseAbs().maxCoeff())
        balance_[f] = row, any = true;
    if (!any)
      findings.push_back({system_.name() + "/sweep", "balance", balance, "",
                          "must be a node of a part that floats freely; no part there needs a balance"});
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
}

/// Sets p to p - C R v, with v from R' (p - C R v) = 0.
void MeanEquilibrium::drag_along(Vector& p) const {
  if (dragged_.empty()) return;
  const auto count = static_cast<Eigen::Index>(dragged_.size());
  Eigen::MatrixXd r(system_.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) r.col(i) = rigid_[dragged_[static_cast<std::size_t>(i)]];
  const Eigen::MatrixXd drag = assembler_.product(damping_, r);
  const Eigen::MatrixXd damping = r.transpose() * drag;
  p -= drag * least_squares(damping, r.transpose() * p);
}

void MeanEquilibrium::solve(Vector& p, Vector* left) {
  drag_along(p);
  if (left != nullptr) left->setZero(static_cast<Eigen::Index>(rigid_.size()));
  for (std::size_t f = 0; f < rigid_.size(); ++f) {
    const Vector& r = rigid_[f];
    const double over = r.dot(p);
    if (left != nullptr) (*left)[static_cast<Eigen::Index>(f)] = over;
    if (!balance_[f].empty()) {
      const double moves = value_along(balance_[f], r);
      for (const Entry& e : balance_[f]) p[e.index] -= e.coeff * over / moves;
    } else {
      const Vector inertia = assembler_.product(system_.mass_values(), r);
      p -= inertia * (over / r.dot(inertia));
    }
  }
  for (Eigen::Index i = 0; i < p.size(); ++i) z_[static_cast<std::size_t>(i)] = p[i];
  elimination_.solve(z_.data());
  for (Eigen::Index i = 0; i < p.size(); ++i) p[i] = z_[static_cast<std::size_t>(i)].real();
}

}  // namespace drev
