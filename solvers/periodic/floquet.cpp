#include "solvers/periodic/floquet.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/law/law_force.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"

namespace drev {

namespace {

Eigen::MatrixXd dense(const Assembler& assembler, const Weights& weights) {
  SparseMatrix matrix = assembler.system().pattern();
  Vector values(matrix.nonZeros());
  assembler.linear_values(weights, values);
  Eigen::Map<Vector>(matrix.valuePtr(), matrix.nonZeros()) = values;
  return Eigen::MatrixXd(matrix);
}

}  // namespace

double largest_floquet_exponent(const System& system, double period, int pieces) {
  Assembler assembler(system);
  const Eigen::Index n = system.size();
  const Eigen::MatrixXd stiffness = dense(assembler, {.k = 1.0});
  const CholeskyFactor mass(dense(assembler, {.m = 1.0}));
  const Eigen::MatrixXd drag = mass.solve(dense(assembler, {.c = 1.0}));
  // Rates are in units of a frequency w of the train, so that z and v/w have the same magnitude.
  const double w = std::sqrt(mass.solve(stiffness).cwiseAbs().rowwise().sum().maxCoeff());
  const Vector rest = Vector::Zero(n);
  std::map<std::vector<double>, Eigen::MatrixXd> turns;  // exponentials by the stiffnesses of the meshes
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (int p = 0; p < pieces; ++p) {
    assembler.set_time((p + 0.5) * period / pieces);
    std::vector<double> slopes;
    Eigen::MatrixXd k = stiffness;
    for (const ScalarTerm& term : system.scalars()) {
      slopes.push_back(assembler.respond(term, rest, rest).dy_dx);
      for (const drev::Entry& a : term.z)
        for (const drev::Entry& b : term.z) k(a.index, b.index) += slopes.back() * a.coeff * b.coeff;
    }
    auto found = turns.find(slopes);
    if (found == turns.end()) {
      Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      rates.topRightCorner(n, n).diagonal().setConstant(w);
      rates.bottomLeftCorner(n, n) = -mass.solve(k) / w;
      rates.bottomRightCorner(n, n) = -drag;
      found = turns.emplace(slopes, exponential(rates * (period / pieces))).first;
    }
    product = found->second * product;
  }
  return std::log(spectral_radius(product)) / period;
}

FloquetProduct::FloquetProduct(const System& system) : system_(system) {
  Assembler assembler(system);
  stiffness_ = dense(assembler, {.k = 1.0});
  inverse_ = CholeskyFactor(dense(assembler, {.m = 1.0})).inverse();
  drag_ = inverse_ * dense(assembler, {.c = 1.0});
  Vector closed;
  assembler.contact_values({.k = 1.0}, Contact::closed, closed);
  SparseMatrix matrix = system.pattern();
  Eigen::Map<Vector>(matrix.valuePtr(), matrix.nonZeros()) = closed;
  w_ = std::sqrt((inverse_ * Eigen::MatrixXd(matrix)).cwiseAbs().rowwise().sum().maxCoeff());
  if (!(w_ > 0.0)) w_ = 1.0;
}

/// Matrix of d(z, z'/w)/dt over a panel, with the slopes that are constant there; varying: receives the other
/// slopes.
Eigen::MatrixXd FloquetProduct::rates(const LawBalance& balance, std::size_t panel,
                                      std::vector<Varying>* varying) const {
  const Eigen::Index n = system_.size();
  Eigen::MatrixXd k = stiffness_, c = Eigen::MatrixXd::Zero(n, n);
  const auto& terms = balance.terms();
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const LawBalance::Slopes& s = balance.slopes(panel, 0, t);
    bool same = true;
    for (int g = 1; g < LawBalance::kPoints && varying != nullptr; ++g)
      same = same && balance.slopes(panel, g, t) == s;
    if (!same) {
      Varying one{&terms[t], Eigen::Matrix<double, LawBalance::kPoints, 3>::Zero()};
      for (int g = 0; g < LawBalance::kPoints; ++g) {
        const LawBalance::Slopes& here = balance.slopes(panel, g, t);
        one.slopes.row(g) << here.x, here.rate, here.angle;
      }
      varying->push_back(one);
      continue;
    }
    for (const drev::Entry& a : terms[t].row) {
      for (const drev::Entry& b : terms[t].row) {
        k(a.index, b.index) += s.x * a.coeff * b.coeff;
        c(a.index, b.index) += s.rate * a.coeff * b.coeff;
      }
      if (s.angle != 0.0)
        for (const drev::Entry& b : terms[t].angle_row) k(a.index, b.index) += s.angle * a.coeff * b.coeff;
    }
  }
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  rates.topRightCorner(n, n).diagonal().setConstant(w_);
  rates.bottomLeftCorner(n, n) = -inverse_ * k / w_;
  rates.bottomRightCorner(n, n) = -drag_ - inverse_ * c;
  return rates;
}

namespace {

constexpr int kOrder = LawBalance::kPoints;
constexpr int kDegree = 30;            // degree of the Taylor series in a step
constexpr double kRadians = 4.0;       // largest norm of rates times step [rad]: 4^30 / 30! = 4e-15
constexpr int kMostPanelSteps = 4096;  // in a panel
using Polynomials =
    Eigen::Matrix<double, kOrder, 3>;  // over a panel from -1 to 1, or over a step from 0 to 1

/// Matrix that gives the coefficients from the values at the Gauss points on [-1, 1].
const Eigen::MatrixXd& coefficients_of_points() {
  static const Eigen::MatrixXd inverse = [] {
    Eigen::MatrixXd powers(kOrder, kOrder);
    for (int g = 0; g < kOrder; ++g)
      for (int j = 0; j < kOrder; ++j)
        powers(g, j) = std::pow(g < 4 ? -kGaussPoints[idx(3 - g)] : kGaussPoints[idx(g - 4)], j);
    return lu_solve(powers, Eigen::MatrixXd(Eigen::MatrixXd::Identity(kOrder, kOrder)));
  }();
  return inverse;
}

/// q(t) = p(a + b t), column by column.
Polynomials shifted(Polynomials p, double a, double b) {
  for (int low = 0; low < kOrder; ++low)  // Horner's rule, once for each degree
    for (int j = kOrder - 2; j >= low; --j) p.row(j) += a * p.row(j + 1);
  for (int j = 1; j < kOrder; ++j) p.bottomRows(kOrder - j) *= b;
  return p;
}

/// A law with varying slopes in a step: q = M^-1 b, and the latest terms of x, x' and the angle, one column
/// each.
struct VaryingLaw {
  Vector q;
  double reach = 0.0, angle_reach = 0.0;                                 // sums of |coefficients| of its rows
  Polynomials slopes = Polynomials::Zero(), here = Polynomials::Zero();  // over panel, over step
  std::array<Eigen::MatrixXd, 3> last;
};

}  // namespace

/// Transition matrix of (z, z'/w) over a panel in which slopes vary; lasts: its duration [s]. The computation
/// is transposed, so that products with rows of terms run over columns.
Eigen::MatrixXd FloquetProduct::varying_turn(const LawBalance& balance, std::size_t panel,
                                             double lasts) const {
  const Eigen::Index n = system_.size(), rows = 2 * n;
  std::vector<Varying> varying;
  const Eigen::MatrixXd rates = this->rates(balance, panel, &varying);
  const Eigen::MatrixXd lower = rates.bottomRows(n).transpose();
  const double stiff = rates.bottomLeftCorner(n, n).cwiseAbs().rowwise().sum().maxCoeff(),
               drag = rates.bottomRightCorner(n, n).cwiseAbs().rowwise().sum().maxCoeff();
  std::vector<VaryingLaw> laws;
  for (const Varying& one : varying) {
    VaryingLaw& law = laws.emplace_back();
    law.q = Vector::Zero(n);
    for (const drev::Entry& a : one.term->row) {
      law.q += a.coeff * inverse_.col(a.index);
      law.reach += std::abs(a.coeff);
    }
    for (const drev::Entry& a : one.term->angle_row) law.angle_reach += std::abs(a.coeff);
    law.slopes = coefficients_of_points() * one.slopes;
    law.last.fill(Eigen::MatrixXd::Zero(rows, kOrder));
  }
  const double sign = balance.direction();
  const auto here = [&](const VaryingLaw& law, int step, int steps) {
    return shifted(law.slopes, sign * (-1.0 + 2.0 * step / steps), sign * 2.0 / steps);
  };
  // Norm of the rates times the step, of the slopes' polynomials by the sum of their terms in the step.
  const auto radians = [&](int step, int steps) {
    double k = stiff, c = drag;
    for (const VaryingLaw& law : laws) {
      const Eigen::RowVector3d sum = here(law, step, steps).cwiseAbs().colwise().sum();
      const double size = law.q.cwiseAbs().maxCoeff();
      k += size / w_ * (law.reach * sum[0] + law.angle_reach * sum[2]);
      c += size * law.reach * sum[1];
    }
    return (std::sqrt(k * w_) + c) * lasts / steps;
  };
  int steps = 1;
  for (int s = 0; s < steps && steps < kMostPanelSteps;)
    if (radians(s, steps) <= kRadians)
      ++s;
    else
      steps += 1 + steps / 4, s = 0;
  const double h = lasts / steps;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(rows, rows), term, next(rows, rows);
  Vector force(rows);
  for (int s = 0; s < steps; ++s) {
    for (VaryingLaw& law : laws) law.here = here(law, s, steps);
    term = sum;
    for (int m = 0; m < kDegree; ++m) {
      next.leftCols(n) = w_ * term.rightCols(n);
      if (rows <= 32)
        next.rightCols(n) = term.lazyProduct(lower);
      else
        next.rightCols(n).noalias() = term * lower;
      for (std::size_t l = 0; l < laws.size(); ++l) {
        VaryingLaw& law = laws[l];
        const Eigen::Index newest = m % kOrder;
        for (auto& last : law.last) last.col(newest).setZero();
        for (const drev::Entry& a : varying[l].term->row) {
          law.last[0].col(newest) += a.coeff * term.col(a.index);
          law.last[1].col(newest) += w_ * a.coeff * term.col(n + a.index);
        }
        for (const drev::Entry& a : varying[l].term->angle_row)
          law.last[2].col(newest) += a.coeff * term.col(a.index);
        force.setZero();
        for (int j = 0; j <= std::min(m, kOrder - 1); ++j)
          for (int i = 0; i < 3; ++i)
            if (law.here(j, i) != 0.0) force += law.here(j, i) * law.last[idx(i)].col((m - j) % kOrder);
        next.rightCols(n).noalias() -= force * (law.q / w_).transpose();
      }
      term = (h / (m + 1)) * next;
      sum += term;
    }
  }
  return sum.transpose();
}

FloquetMultipliers FloquetProduct::multipliers(const LawBalance& balance, double speed) const {
  const auto& panels = balance.panels();
  const Eigen::Index n = system_.size();
  const double time = balance.turns() / speed;  // time of one radian of the cycle [s/rad]
  const auto same = [&](std::size_t a, std::size_t b) {
    if (!panels[a].constant || !panels[b].constant) return false;
    for (std::size_t t = 0; t < balance.terms().size(); ++t)
      if (!(balance.slopes(a, 0, t) == balance.slopes(b, 0, t))) return false;
    return true;
  };
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const bool forward = balance.direction() > 0.0;
  const auto jump_at = [&](std::size_t panel) {
    for (const LawBalance::Jump& jump : balance.jumps())
      if (jump.panel == panel) return true;
    return false;
  };
  // Where x crosses a jump of a force, dz' changes by -M^-1 b [y]/|x'| b' dz.
  const auto pass_jumps = [&](std::size_t panel) {
    for (const LawBalance::Jump& jump : balance.jumps()) {
      if (jump.panel != panel) continue;
      const auto& row = balance.terms()[jump.term].row;
      Eigen::RowVectorXd x = Eigen::RowVectorXd::Zero(2 * n);
      for (const drev::Entry& e : row) x += e.coeff * product.row(e.index);
      for (const drev::Entry& e : row)
        product.bottomRows(n) -= (jump.impulse / w_ * e.coeff) * inverse_.col(e.index) * x;
    }
  };
  for (std::size_t i = 0; i < panels.size();) {
    const std::size_t first = forward ? i : panels.size() - 1 - i;
    double length = panels[first].to - panels[first].from;
    std::size_t next = i + 1;
    for (; next < panels.size(); ++next) {
      const std::size_t p = forward ? next : panels.size() - 1 - next;
      if (!same(first, p) || jump_at(forward ? p : p + 1)) break;
      length += panels[p].to - panels[p].from;
    }
    i = next;
    const double lasts = length * time;
    if (forward) pass_jumps(first);
    product = (panels[first].constant ? exponential(rates(balance, first, nullptr) * lasts)
                                      : varying_turn(balance, first, lasts)) *
              product;
    if (!forward) pass_jumps(panels.size() - i);
  }
  FloquetMultipliers out;
  const GeneralEigen all = general_eigen(product);
  if (!all.converged) {
    out.largest = NAN;
    return out;
  }
  std::vector<std::complex<double>> values(all.values.begin(), all.values.end());
  std::stable_sort(values.begin(), values.end(),
                   [](const auto& x, const auto& y) { return std::abs(x - 1.0) < std::abs(y - 1.0); });
  const std::size_t rigid = std::min(values.size(), 2 * balance.mean().floating().size());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rigid));
  out.values = Eigen::Map<Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size()));
  std::complex<double> at_minus_one = 1.0;
  for (const std::complex<double>& value : values) {
    out.largest = std::max(out.largest, std::abs(value));
    at_minus_one *= 1.0 + value;
    if (std::abs(value) <= 1.0 + kRounding) continue;
    ++out.outside;
    out.complex_outside = out.complex_outside || std::abs(value.imag()) > 1e-9 * std::abs(value);
  }
  out.at_minus_one = at_minus_one.real();
  return out;
}

}  // namespace drev
