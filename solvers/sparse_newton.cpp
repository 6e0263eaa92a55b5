#include "solvers/sparse_newton.hpp"

#include <cmath>
#include <limits>

#include "solvers/line_search.hpp"

namespace drev {

namespace {
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
}

SparseNewton::SparseNewton(const System& system) : system_(system) {
  if (system.symmetric_tangent())
    cholesky_ = std::make_unique<SparseCholesky>();
  else
    lu_ = std::make_unique<SparseLu>();
}

double SparseNewton::residual(const Assembler& assembler, const SparseNewtonProblem& p,
                              const Vector& w, Vector& history_new) {
  // Also keeps the largest force in it, and what rounding alone contributes.
  scale_ = rounding_ = 0.0;
  const auto note = [this](const Vector& part) {
    scale_ = std::max(scale_, part.lpNorm<Eigen::Infinity>());
  };
  z_ = *p.z_0 + p.kappa_z * w;
  v_ = *p.v_0 + p.kappa_v * w;
  assembler.multiply_stiffness(z_, r_);
  note(r_);
  if (p.mu != 0.0 || p.kappa_v != 0.0) {
    assembler.multiply_damping(v_, part_);
    note(part_);
    r_ += part_;
  }
  part_.setZero(r_.size());
  assembler.add_scalar_forces(z_, v_, part_);
  assembler.add_general_forces(z_, v_, *p.history, part_, history_new);
  note(part_);
  r_ += part_;
  assembler.external(z_, v_, part_);
  note(part_);
  r_ -= part_;
  r_ *= p.phi;
  if (p.mu != 0.0) {
    assembler.multiply_mass(w, part_);
    note(part_);
    r_ += p.mu * part_;
  }
  if (p.r_0) r_ += *p.r_0;
  const SparseMatrix& pattern = system_.pattern();
  for (int k = 0; k < pattern.cols(); ++k)
    for (int s = pattern.outerIndexPtr()[k]; s < pattern.outerIndexPtr()[k + 1]; ++s)
      rounding_ = std::max(rounding_,
                           16 * kEpsilon * std::abs(system_.stiffness_values()[s] * z_[k]));
  for (const ScalarTerm& term : system_.scalars()) {
    const ScalarResponse r = assembler.respond(term, z_, v_);
    double x = 0.0;
    for (const Entry& e : term.z) x += std::abs(e.coeff * z_[e.index]);
    for (const Entry& e : term.z)
      rounding_ = std::max(rounding_, 16 * kEpsilon * std::abs(e.coeff * r.dy_dx) * x);
  }
  return r_.allFinite() ? r_.lpNorm<Eigen::Infinity>()
                        : std::numeric_limits<double>::quiet_NaN();
}

NewtonStatus SparseNewton::direction(const Assembler& assembler, const SparseNewtonProblem& p,
                                     const Vector& history) {
  const Weights weights{p.mu, p.phi * p.kappa_v, p.phi * p.kappa_z};
  // The loads' own slopes first; if they spoil definiteness, without them.
  for (const bool with_loads : {true, false}) {
    assembler.tangent_values(weights, z_, v_, history, with_loads, values_);
    if (p.shift != 0.0) values_ += p.shift * system_.mass_values();
    ++factorizations_;
    if (lu_) {
      if (lu_->factorize(system_.pattern(), values_) != FactorStatus::success)
        return NewtonStatus::singular;
      lu_->solve(r_, direction_);
    } else {
      if (cholesky_->factorize(system_.pattern(), values_) != FactorStatus::success) continue;
      cholesky_->solve(r_, direction_);
    }
    direction_ = -direction_;
    return direction_.allFinite() ? NewtonStatus::converged : NewtonStatus::singular;
  }
  return NewtonStatus::singular;
}

NewtonResult SparseNewton::solve(const Assembler& assembler, const SparseNewtonProblem& p,
                                 const Options& options, Vector& w, Vector& history_new) {
  NewtonResult result;
  history_new.resize(system_.history_size());
  double size = residual(assembler, p, w, history_new);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    if (!std::isfinite(size)) {
      result.status = NewtonStatus::not_finite;
      return result;
    }
    if (size <= options.tolerance * scale_ + rounding_) return result;
    result.status = direction(assembler, p, *p.history);
    if (result.status != NewtonStatus::converged) return result;
    const double g_0 = r_.dot(direction_);
    kinks_.clear();
    for (const ScalarTerm& term : system_.scalars()) {
      double rate = 0.0;
      for (const Entry& e : term.z) rate += p.kappa_z * e.coeff * direction_[e.index];
      if (rate == 0.0) continue;
      const double x = assembler.input(term, z_, v_).x;
      for (const double kink : term.force->kinks())
        if ((kink - x) / rate > 0.0) kinks_.push_back((kink - x) / rate);
    }
    trial_ = w + direction_;
    const double full = residual(assembler, p, trial_, history_new);
    if (!options.line_search || !(g_0 < 0.0) || full <= options.tolerance * scale_ + rounding_) {
      w = trial_;
      size = full;
      continue;
    }
    const auto slope = [&](double alpha) {
      trial_ = w + alpha * direction_;
      residual(assembler, p, trial_, history_new);
      return r_.dot(direction_);
    };
    const double alpha = exact_line_search(slope, g_0, kinks_);
    trial_ = w + alpha * direction_;
    size = residual(assembler, p, trial_, history_new);
    if ((trial_ - w).lpNorm<Eigen::Infinity>() <= kEpsilon * trial_.lpNorm<Eigen::Infinity>() &&
        size > options.tolerance * scale_ + rounding_) {
      result.status = NewtonStatus::no_root;
      return result;
    }
    w = trial_;
  }
  result.status = NewtonStatus::too_many_steps;
  return result;
}

}  // namespace drev
