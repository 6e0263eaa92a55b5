#include "solvers/stepping/step_equation.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/linear/huge_pages.hpp"
#include "solvers/linear/vector_kernels.hpp"
#include "solvers/run/run_verdict.hpp"

namespace drev {

namespace {
constexpr double kSameStep = 1e-10;  // relative: one factor serves steps that differ by rounding
constexpr std::size_t kMaxFactors = 16;
constexpr int kPhasePasses = 4;       // each brings the mesh phase two orders of h nearer
constexpr int kUsedOften = 4;         // solves for each unknown: what the inverse costs is earned back
constexpr double kInvertible = 1e-8;  // reciprocal condition: what the inverse loses stays small
}  // namespace

StepEquation::StepEquation(const System& system, StepScheme scheme, StepOptions options)
    : system_(system),
      assembler_(system),
      scheme_(std::move(scheme)),
      options_(options),
      dense_(system.generals().empty() &&
             static_cast<int>(system.scalars().size()) <= options.max_dense_contacts),
      phases_(std::any_of(system.scalars().begin(), system.scalars().end(),
                          [](const ScalarTerm& term) { return term.phase_node >= 0; })),
      moves_(phases_ || system.table_loads().size() > 0 || system.loads_depend_on_motion()),
      mass_product_(system.pattern(), system.mass_values()),
      damping_(system.pattern(), system.damping_values()),
      stiffness_(system.pattern(), system.stiffness_values()),
      lambda_(Vector::Zero(static_cast<Eigen::Index>(system.scalars().size()))),
      given_(system.scalars().size()),
      free_(system.scalars().size()),
      clock_(options.time_phases) {
  if (!dense_) sparse_ = std::make_unique<SparseNewton>(system);
  for (Vector* x : {&linear_, &rhs_, &scratch_}) set_zeros(*x, system.size());
}

StepEquation::Factor& StepEquation::find_factor(double h) {
  const auto fits = [h](const auto& f) { return std::abs(f->h - h) <= kSameStep * h; };
  for (auto f = factors_.rbegin(); f != factors_.rend(); ++f)
    if (fits(*f)) {
      std::rotate(f.base() - 1, f.base(), factors_.end());
      return *factors_.back();
    }
  if (factors_.size() == kMaxFactors) factors_.erase(factors_.begin());
  auto f = std::make_unique<Factor>(Factor{h, SparseCholesky(), ContactNewton(), Eigen::MatrixXd(), 0, {}});
  const Weights weights = scheme_.weights(h);
  assembler_.linear_values(weights, values_);
  ++factorizations_;
  if (f->cholesky.factorize(system_.pattern(), values_) != FactorStatus::success)
    throw SolverError(why_no_factor(system_, scheme_.name, h, weights));
  const auto m = static_cast<Eigen::Index>(system_.scalars().size());
  f->w.resize(system_.size(), m);
  Eigen::MatrixXd compliance(m, m);
  Vector column(system_.size()), solved(system_.size());
  for (Eigen::Index j = 0; j < m; ++j) {
    column.setZero();
    for (const Entry& e : system_.scalars()[idx(static_cast<int>(j))].z) column[e.index] += e.coeff;
    f->cholesky.solve(column, solved);
    f->w.col(j) = solved;
  }
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j) {
      compliance(i, j) = 0.0;
      for (const Entry& e : system_.scalars()[idx(static_cast<int>(i))].z)
        compliance(i, j) += e.coeff * f->w(e.index, j);
    }
  // x = z-part: beta h^2 b^T a; with a = a_linear - (1 - alpha_f) W lambda.
  f->contact = ContactNewton(system_, std::move(compliance), weights.k, weights.c);
  factors_.push_back(std::move(f));
  return *factors_.back();
}

void StepEquation::invert(Factor& f) {
  const int n = system_.size(), stride = whole_lanes(n);
  f.inverse.setZero(n * stride);
  Vector column(n), solved(n);
  for (int j = 0; j < n; ++j) {
    column = Vector::Unit(n, j);
    f.cholesky.solve(column, solved);
    std::copy_n(solved.data(), n, f.inverse.data() + j * stride);
  }
}

void StepEquation::solve_by_factor(Factor& f, const Vector& b, Vector& x) {
  const int n = system_.size();
  f.cholesky.solve(b, x);
  if (n <= kLargestDense && ++f.used == kUsedOften * n && f.cholesky.reciprocal_condition() > kInvertible)
    invert(f);
}

void StepEquation::evaluate(const Vector& history, EvaluatedState& point, Vector* history_new) {
  evaluate_laws(assembler_, point);
  assembler_.external(point.state.z, point.state.v, point.p);
  evaluate_totals(history, point, history_new);
}

void StepEquation::evaluate_totals(const Vector& history, EvaluatedState& point, Vector* history_new) {
  const State& s = point.state;
  assembler_.multiply_stiffness(s.z, point.kz);
  assembler_.multiply_damping(s.v, point.cv);
  point.total = point.kz + point.cv - point.p;
  add_law_forces(system_, point, 1.0, point.total);
  if (!system_.generals().empty()) {
    history_.resize(system_.history_size());
    assembler_.add_general_forces(s.z, s.v, history, point.total, history_);
    std::tie(point.general_energy, point.general_power) = assembler_.general_energy(s, history);
    if (history_new) *history_new = history_;
  }
}

void StepEquation::acceleration(const Vector& total, Vector& a) {
  if (!mass_.ok()) {
    ++factorizations_;
    if (mass_.factorize(system_.pattern(), system_.mass_values()) != FactorStatus::success)
      throw SolverError(system_.name() + ": the mass matrix is not positive definite");
  }
  ++solves_;
  rhs_ = -total;
  mass_.solve(rhs_, a);
}

void StepEquation::filter(double h, Vector& e_z, Vector& e_v) {
  if (!dense_) return;
  Factor& f = factor(h);
  const double phi = 1.0 - scheme_.alpha_f;
  assembler_.multiply_mass(e_v, rhs_);
  rhs_ *= 1.0 - scheme_.alpha_m;
  assembler_.multiply_stiffness(e_z, scratch_);
  rhs_ -= (phi * scheme_.gamma * h) * scratch_;
  f.cholesky.solve(rhs_, e_v);
  e_z += (scheme_.beta / scheme_.gamma * h) * e_v;
}

void StepEquation::start_from(const EvaluatedState& point) {
  for (std::size_t j = 0; j < point.responses.size(); ++j)
    lambda_[static_cast<Eigen::Index>(j)] = point.responses[j].y;
}

double largest_force(const EvaluatedState& point) {
  const int n = static_cast<int>(point.p.size());
  double largest = std::max(0.0, largest_of_both(n, point.p.data(), point.kz.data()));
  for (const ScalarResponse& r : point.responses) largest = std::max(largest, std::abs(r.y));
  return largest;
}

void StepEquation::totals(const EvaluatedState& from, const Vector& a_0, EvaluatedState& to) {
  if (!dense_) return evaluate_totals(from.state.history, to, nullptr);
  const StepScheme& c = scheme_;
  const double* cv = nullptr;
  mass_product_.multiply(-(1.0 - c.alpha_m) / (1.0 - c.alpha_f), to.state.a, to.total);
  if (c.alpha_m != 0.0) {
    mass_product_.multiply_add(-c.alpha_m / (1.0 - c.alpha_f), a_0, to.total, scratch_);
    to.total.swap(scratch_);
  }
  if (c.alpha_f != 0.0) to.total -= (c.alpha_f / (1.0 - c.alpha_f)) * from.total;
  if (!damping_.zero()) {
    damping_.multiply(1.0, to.state.v, to.cv);
    cv = to.cv.data();
  } else if (to.cv.size() != to.p.size()) {
    to.cv.setZero(to.p.size());
  }
  to.kz.resize(to.p.size());
  elastic_forces(system_.size(), to.total.data(), to.p.data(), cv, to.kz.data());
  add_law_forces(system_, to, -1.0, to.kz);
}

double StepEquation::correct(const Problem& problem, EvaluatedState& to) const {
  const int n = system_.size();
  if (to.state.z.size() != n) to.state.z.setZero(n);  // its change is taken
  to.state.v.resize(n);
  return correct_motion(n, scheme_.beta * problem.h * problem.h, scheme_.gamma * problem.h,
                        problem.z_0.data(), problem.v_0.data(), to.state.a.data(), to.state.z.data(),
                        to.state.v.data());
}

NewtonResult StepEquation::solve_dense(Problem& problem, EvaluatedState& to) {
  Factor& f = factor(problem.h);
  const double phi = 1.0 - scheme_.alpha_f;
  const int n = system_.size();
  const std::size_t m = system_.scalars().size();
  stiffness_.multiply(-phi, problem.z_0, linear_);
  if (!damping_.zero()) {
    damping_.multiply_add(-phi, problem.v_0, linear_, scratch_);
    linear_.swap(scratch_);
  }
  if (problem.known) linear_ += *problem.known;

  // Loads start at the state that the old acceleration predicts. The mesh phase is taken there too: it is
  // off by O(h^3), and a stepped stiffness cannot flip to and fro inside the iteration. Methods of higher
  // order take it again in the first passes.
  if (moves_) {
    to.state.a = *problem.a_start;
    correct(problem, to);
  }
  clock_.enter(RunSection::loads);
  assembler_.external(to.state.z, to.state.v, to.p);
  for (std::size_t j = 0; j < m; ++j) given_[j] = assembler_.given_input(system_.scalars()[j]);
  const auto take_phase = [&] {
    if (!phases_) return;
    for (std::size_t j = 0; j < m; ++j)
      if (system_.scalars()[j].phase_node >= 0)
        given_[j].angle = assembler_.node_angle(system_.scalars()[j].phase_node, to.state.z);
  };
  take_phase();
  const int phase_passes = phases_ && scheme_.order() > 2 ? kPhasePasses : 1;
  lambda_start_ = lambda_;
  const double kappa_z = scheme_.beta * problem.h * problem.h, kappa_v = scheme_.gamma * problem.h;
  const double rate = kappa_v / kappa_z;

  NewtonResult result;
  double change = 0.0;  // change of z since the loads were evaluated
  for (int pass = 1;; ++pass) {
    ++load_passes_;
    clock_.enter(RunSection::linear);
    rhs_.resize(n);
    sum_with(n, linear_.data(), phi, to.p.data(), rhs_.data());
    ++solves_;
    to.state.a.resize(n);
    if (f.inverse.size() == 0)
      solve_by_factor(f, rhs_, to.state.a);
    else
      dense_product(n, whole_lanes(n), f.inverse.data(), rhs_.data(), to.state.a.data());
    const double scale = force_scale_ > 0.0 ? force_scale_ : largest_size(n, to.p.data());
    if (m > 0) {
      clock_.enter(RunSection::contacts);
      for (std::size_t j = 0; j < m; ++j) {
        double x = given_[j].x, x_dot = given_[j].x_dot;
        for (const Entry& e : system_.scalars()[j].z) {
          const double a = to.state.a.data()[e.index];
          x += e.coeff * (problem.z_0.data()[e.index] + kappa_z * a);
          x_dot += e.coeff * (problem.v_0.data()[e.index] + kappa_v * a);
        }
        free_[j] = {x, x_dot, given_[j].t, given_[j].angle};
      }
      const NewtonResult contact = f.contact.solve(free_, scale, options_.contact, lambda_);
      result.iterations += contact.iterations;
      const bool jump = contact.status == NewtonStatus::no_root && problem.accept_jump;
      if (contact.status != NewtonStatus::converged && !jump) {
        result.status = contact.status;
        lambda_ = lambda_start_;
        return result;
      }
      result.inside_jump = result.inside_jump || jump;
      for (Eigen::Index j = 0; j < lambda_.size(); ++j)
        add_multiple(n, -phi * lambda_[j], f.w.data() + j * n, to.state.a.data());
    } else {
      ++result.iterations;
    }
    change = correct(problem, to);
    const bool phases_left = pass < phase_passes;
    // A motion that is not finite ends the passes too.
    if (!phases_left && (!system_.loads_depend_on_motion() ||
                         !(assembler_.load_steepness(rate) * change > options_.load_tolerance * scale)))
      break;
    clock_.enter(RunSection::loads);
    const bool known_steepness = std::isfinite(assembler_.load_steepness(rate));
    if (!known_steepness) p_last_ = to.p;
    assembler_.external(to.state.z, to.state.v, to.p);
    if (phases_left) {
      take_phase();
      continue;
    }
    if (!known_steepness &&
        !(largest_difference(n, to.p.data(), p_last_.data()) > options_.load_tolerance * scale))
      break;
    if (pass == options_.max_load_passes) {
      result.status = NewtonStatus::too_many_steps;
      return result;
    }
  }
  if (!std::isfinite(change)) {
    result.status = NewtonStatus::not_finite;
    return result;
  }
  if (m > 0) {
    f.contact.hand_over_laws(to.inputs, to.responses);
    if (problem.accept_jump)
      for (std::size_t j = 0; j < m; ++j) to.responses[j].y = lambda_[static_cast<Eigen::Index>(j)];
  }
  return result;
}

NewtonResult StepEquation::solve_sparse(const Problem& problem, EvaluatedState& to) {
  const double phi = 1.0 - scheme_.alpha_f, h = problem.h;
  if (problem.known)
    scratch_ = -*problem.known;
  else
    scratch_.setZero(system_.size());
  const SparseNewtonProblem sparse{.mu = 1.0 - scheme_.alpha_m,
                                   .phi = phi,
                                   .kappa_z = scheme_.beta * h * h,
                                   .kappa_v = scheme_.gamma * h,
                                   .z_0 = &problem.z_0,
                                   .v_0 = &problem.v_0,
                                   .r_0 = &scratch_,
                                   .history = problem.history};
  to.state.a = *problem.a_start;
  to.state.history = *problem.history;
  const NewtonResult result = sparse_->solve(assembler_, sparse, {}, to.state.a, to.state.history);
  solves_ += result.iterations;
  if (result.status != NewtonStatus::converged) return result;
  correct(problem, to);
  sparse_->hand_over_laws(to.inputs, to.responses);
  assembler_.external(to.state.z, to.state.v, to.p);
  return result;
}

}  // namespace drev
