#include "solvers/step_solver.hpp"

#include <cmath>

namespace drev {

namespace {
constexpr double kSameStep = 1e-10;  // relative: one factor serves steps that differ by rounding
constexpr std::size_t kMaxFactors = 16;
}  // namespace

StepSolver::StepSolver(const System& system, StepScheme scheme, StepOptions options)
    : system_(system),
      assembler_(system),
      scheme_(std::move(scheme)),
      options_(options),
      dense_(system.generals().empty() &&
             static_cast<int>(system.scalars().size()) <= options.max_dense_contacts),
      lambda_(Vector::Zero(static_cast<Eigen::Index>(system.scalars().size()))),
      free_(system.scalars().size()),
      clock_(options.time_phases) {
  if (!dense_) sparse_ = std::make_unique<SparseNewton>(system);
}

StepSolver::Factor& StepSolver::factor(double h) {
  for (auto& f : factors_)
    if (std::abs(f->h - h) <= kSameStep * h) return *f;
  if (factors_.size() == kMaxFactors) factors_.erase(factors_.begin());
  auto f = std::make_unique<Factor>(
      Factor{h, SparseCholesky(), ContactNewton(), Eigen::MatrixXd()});
  const Weights weights = scheme_.weights(h);
  assembler_.linear_values(weights, values_);
  ++factorizations_;
  if (f->cholesky.factorize(system_.pattern(), values_) != FactorStatus::success)
    throw SolverError(system_.name() + ": the step matrix of " + scheme_.name + " at h = " +
                      to_text(h) + " s is not positive definite; is a stiffness negative?");
  const auto m = static_cast<Eigen::Index>(system_.scalars().size());
  f->w.resize(system_.size(), m);
  Eigen::MatrixXd compliance(m, m);
  Vector column(system_.size()), solved(system_.size());
  for (Eigen::Index j = 0; j < m; ++j) {
    column.setZero();
    for (const Entry& e : system_.scalars()[at(static_cast<int>(j))].z)
      column[e.index] += e.coeff;
    f->cholesky.solve(column, solved);
    f->w.col(j) = solved;
  }
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j) {
      compliance(i, j) = 0.0;
      for (const Entry& e : system_.scalars()[at(static_cast<int>(i))].z)
        compliance(i, j) += e.coeff * f->w(e.index, j);
    }
  // x = z-part: beta h^2 b^T a; with a = a_linear - (1 - alpha_f) W lambda.
  f->contact = ContactNewton(system_, std::move(compliance), weights.k, weights.c);
  factors_.push_back(std::move(f));
  return *factors_.back();
}

void StepSolver::evaluate(StepPoint& point) {
  point.inputs.resize(system_.scalars().size());
  point.responses.resize(system_.scalars().size());
  for (std::size_t j = 0; j < system_.scalars().size(); ++j) {
    point.inputs[j] = assembler_.input(system_.scalars()[j], point.state.z, point.state.v);
    point.responses[j] = system_.scalars()[j].force->evaluate(point.inputs[j]);
  }
  assembler_.external(point.state.z, point.state.v, point.p);
  evaluate_totals(point.state.history, point);
}

void StepSolver::evaluate_totals(const Vector& history, StepPoint& point) {
  const State& s = point.state;
  assembler_.multiply_stiffness(s.z, point.kz);
  assembler_.multiply_damping(s.v, point.cv);
  point.total = point.kz + point.cv - point.p;
  for (std::size_t j = 0; j < system_.scalars().size(); ++j)
    for (const Entry& e : system_.scalars()[j].z)
      point.total[e.index] += e.coeff * point.responses[j].y;
  if (!system_.generals().empty()) {
    scratch_.resize(system_.history_size());
    assembler_.add_general_forces(s.z, s.v, history, point.total, scratch_);
    std::tie(point.general_energy, point.general_power) = assembler_.general_energy(s, history);
  }
}

void StepSolver::update_scale(const StepPoint& point) {
  force_scale_ = std::max(force_scale_, point.p.lpNorm<Eigen::Infinity>());
  force_scale_ = std::max(force_scale_, point.kz.lpNorm<Eigen::Infinity>());
  for (std::size_t j = 0; j < point.responses.size(); ++j)
    force_scale_ = std::max(force_scale_, std::abs(point.responses[j].y));
}

void StepSolver::start(StepPoint& point) {
  assembler_.set_time(point.state.t);
  evaluate(point);
  SparseCholesky mass;
  ++factorizations_;
  if (mass.factorize(system_.pattern(), system_.mass_values()) != FactorStatus::success)
    throw SolverError(system_.name() + ": the mass matrix is not positive definite");
  rhs_ = -point.total;
  mass.solve(rhs_, point.state.a);
  for (std::size_t j = 0; j < point.responses.size(); ++j)
    lambda_[static_cast<Eigen::Index>(j)] = point.responses[j].y;
  update_scale(point);
}

NewtonResult StepSolver::step(const StepPoint& from, double h, double t_new, double t_evaluate,
                              StepPoint& to) {
  clock_.enter(Phase::linear);
  assembler_.set_time(t_evaluate);
  const State& s = from.state;
  z_predicted_ = s.z + h * s.v + (h * h * (0.5 - scheme_.beta)) * s.a;
  v_predicted_ = s.v + (h * (1.0 - scheme_.gamma)) * s.a;
  // What of the residual is known: alpha_m M a0 + alpha_f F0.
  rhs_base_.setZero(system_.size());
  if (scheme_.alpha_m != 0.0) {
    assembler_.multiply_mass(s.a, scratch_);
    rhs_base_ -= scheme_.alpha_m * scratch_;
  }
  if (scheme_.alpha_f != 0.0) rhs_base_ -= scheme_.alpha_f * from.total;
  to.state.history = s.history;
  const NewtonResult result =
      dense_ ? solve_dense(from, h, to) : solve_sparse(from, h, to);
  if (result.status != NewtonStatus::converged) return result;
  to.state.t = t_new;
  clock_.enter(Phase::linear);
  if (dense_)
    totals_from_motion(from, to);
  else
    evaluate_totals(s.history, to);
  update_scale(to);
  return result;
}

void StepSolver::totals_from_motion(const StepPoint& from, StepPoint& to) {
  // The step's own equation gives the total force: no product with K is needed.
  const StepScheme& c = scheme_;
  assembler_.multiply_mass(to.state.a, to.total);
  to.total *= -(1.0 - c.alpha_m) / (1.0 - c.alpha_f);
  if (c.alpha_m != 0.0) {
    assembler_.multiply_mass(from.state.a, scratch_);
    to.total -= (c.alpha_m / (1.0 - c.alpha_f)) * scratch_;
  }
  if (c.alpha_f != 0.0) to.total -= (c.alpha_f / (1.0 - c.alpha_f)) * from.total;
  assembler_.multiply_damping(to.state.v, to.cv);
  to.kz = to.total + to.p - to.cv;
  for (std::size_t j = 0; j < system_.scalars().size(); ++j)
    for (const Entry& e : system_.scalars()[j].z) to.kz[e.index] -= e.coeff * to.responses[j].y;
}

void StepSolver::correct(double h, StepPoint& to) const {
  to.state.z = z_predicted_ + (scheme_.beta * h * h) * to.state.a;
  to.state.v = v_predicted_ + (scheme_.gamma * h) * to.state.a;
}

NewtonResult StepSolver::solve_dense(const StepPoint& from, double h, StepPoint& to) {
  Factor& f = factor(h);
  const double phi = 1.0 - scheme_.alpha_f;
  const std::size_t m = system_.scalars().size();
  assembler_.multiply_stiffness(z_predicted_, scratch_);
  rhs_base_ -= phi * scratch_;
  assembler_.multiply_damping(v_predicted_, scratch_);
  rhs_base_ -= phi * scratch_;

  // Loads start at the state that the old acceleration predicts. The mesh phase is taken there too: it is
  // off by O(h^3), and a stepped stiffness cannot flip to and fro inside the iteration.
  to.state.a = from.state.a;
  correct(h, to);
  clock_.enter(Phase::loads);
  assembler_.external(to.state.z, to.state.v, to.p);
  to.inputs.resize(m);
  to.responses.resize(m);
  std::vector<ScalarInput>& phase = to.inputs;
  for (std::size_t j = 0; j < m; ++j)
    phase[j].angle = assembler_.input(system_.scalars()[j], to.state.z, to.state.v).angle;

  NewtonResult result;
  for (int pass = 1;; ++pass) {
    ++load_passes_;
    clock_.enter(Phase::linear);
    rhs_ = rhs_base_ + phi * to.p;
    f.cholesky.solve(rhs_, to.state.a);
    if (m > 0) {
      correct(h, to);
      clock_.enter(Phase::contacts);
      for (std::size_t j = 0; j < m; ++j) {
        free_[j] = assembler_.input(system_.scalars()[j], to.state.z, to.state.v);
        free_[j].angle = phase[j].angle;
      }
      const double scale = std::max(force_scale_, to.p.lpNorm<Eigen::Infinity>());
      const NewtonResult contact = f.contact.solve(free_, scale, options_.contact, lambda_);
      result.iterations += contact.iterations;
      if (contact.status != NewtonStatus::converged) {
        result.status = contact.status;
        for (std::size_t j = 0; j < m; ++j)
          lambda_[static_cast<Eigen::Index>(j)] = from.responses[j].y;
        return result;
      }
      to.state.a.noalias() -= phi * (f.w * lambda_);
    } else {
      ++result.iterations;
    }
    correct(h, to);
    if (!to.state.a.allFinite()) {
      result.status = NewtonStatus::not_finite;
      return result;
    }
    if (!system_.loads_depend_on_motion()) break;
    clock_.enter(Phase::loads);
    p_last_ = to.p;
    assembler_.external(to.state.z, to.state.v, to.p);
    const double scale = std::max(force_scale_, to.p.lpNorm<Eigen::Infinity>());
    if ((to.p - p_last_).lpNorm<Eigen::Infinity>() <= options_.load_tolerance * scale) break;
    if (pass == options_.max_load_passes) {
      result.status = NewtonStatus::too_many_steps;
      return result;
    }
  }
  if (m > 0) {
    to.inputs = f.contact.inputs();
    to.responses = f.contact.responses();
  }
  return result;
}

NewtonResult StepSolver::solve_sparse(const StepPoint& from, double h, StepPoint& to) {
  const double phi = 1.0 - scheme_.alpha_f;
  scratch_ = -rhs_base_;
  SparseNewtonProblem problem{.mu = 1.0 - scheme_.alpha_m,
                              .phi = phi,
                              .kappa_z = scheme_.beta * h * h,
                              .kappa_v = scheme_.gamma * h,
                              .z_0 = &z_predicted_,
                              .v_0 = &v_predicted_,
                              .r_0 = &scratch_,
                              .history = &from.state.history};
  to.state.a = from.state.a;
  const NewtonResult result =
      sparse_->solve(assembler_, problem, {}, to.state.a, to.state.history);
  if (result.status != NewtonStatus::converged) return result;
  correct(h, to);
  to.inputs.resize(system_.scalars().size());
  to.responses.resize(system_.scalars().size());
  for (std::size_t j = 0; j < system_.scalars().size(); ++j) {
    to.inputs[j] = assembler_.input(system_.scalars()[j], to.state.z, to.state.v);
    to.responses[j] = system_.scalars()[j].force->evaluate(to.inputs[j]);
  }
  assembler_.external(to.state.z, to.state.v, to.p);
  return result;
}

}  // namespace drev
