#include "solvers/contact/sparse_newton.hpp"

#include <cmath>
#include <limits>

#include "solvers/contact/line_search.hpp"

namespace drev {

namespace {
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
}

SparseNewton::SparseNewton(const System& system)
    : system_(system),
      only_laws_vary_(system.generals().empty() && !system.loads_depend_on_motion()),
      inputs_(system.scalars().size()),
      responses_(system.scalars().size()),
      slopes_(system.scalars().size()) {
  if (system.symmetric_tangent())
    cholesky_ = std::make_unique<SparseCholesky>();
  else
    lu_ = std::make_unique<SparseLu>();
}

double SparseNewton::residual(const Assembler& assembler, const SparseNewtonProblem& p, const Vector& w,
                              Vector& history_new) {
  // Also keeps the largest force in it, and what rounding alone contributes.
  scale_ = 0.0;
  const auto note = [this](const Vector& part) { scale_ = std::max(scale_, part.lpNorm<Eigen::Infinity>()); };
  z_ = *p.z_0 + p.kappa_z * w;
  v_ = *p.v_0 + p.kappa_v * w;
  const SparseMatrix& pattern = system_.pattern();
  const Vector& stiffness = system_.stiffness_values();
  r_.resize(z_.size());
  double largest = 0.0;  // largest product in K z
  for (int row = 0; row < pattern.cols(); ++row) {
    double sum = 0.0;
    for (int s = pattern.outerIndexPtr()[row]; s < pattern.outerIndexPtr()[row + 1]; ++s) {
      const double kz = stiffness[s] * z_[pattern.innerIndexPtr()[s]];
      sum += kz;
      largest = std::max(largest, std::abs(kz));
    }
    r_[row] = sum;
  }
  note(r_);
  if (p.mu != 0.0 || p.kappa_v != 0.0) {
    assembler.multiply_damping(v_, part_);
    note(part_);
    r_ += part_;
  }
  part_.setZero(r_.size());
  for (std::size_t j = 0; j < system_.scalars().size(); ++j) {
    const ScalarTerm& term = system_.scalars()[j];
    inputs_[j] = assembler.input(term, z_, v_);
    const ScalarResponse& r = responses_[j] = term.force->evaluate(inputs_[j]);
    double x = 0.0;
    for (const Entry& e : term.z) {
      part_[e.index] += e.coeff * r.y;
      x += std::abs(e.coeff * z_[e.index]);
    }
    for (const Entry& e : term.z) largest = std::max(largest, std::abs(e.coeff * r.dy_dx) * x);
  }
  assembler.add_general_forces(z_, v_, *p.history, part_, history_new);
  note(part_);
  r_ += part_;
  if (p.loads)
    part_ = *p.loads;
  else
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
  rounding_ = 16 * kEpsilon * largest;
  return r_.allFinite() ? r_.lpNorm<Eigen::Infinity>() : std::numeric_limits<double>::quiet_NaN();
}

bool SparseNewton::same_tangent(const Weights& w, double shift) {
  bool same = only_laws_vary_ && tangent_kept_ && w.m == weights_.m && w.c == weights_.c &&
              w.k == weights_.k && shift == shift_;
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    const double slope = w.k * responses_[j].dy_dx + w.c * responses_[j].dy_dx_dot;
    same = same && slope == slopes_[j];
    slopes_[j] = slope;
  }
  weights_ = w;
  shift_ = shift;
  return same;
}

NewtonStatus SparseNewton::direction(const Assembler& assembler, const SparseNewtonProblem& p,
                                     const Vector& history) {
  const Weights weights{p.mu, p.phi * p.kappa_v, p.phi * p.kappa_z};
  const auto solve = [this] {
    if (lu_)
      lu_->solve(r_, direction_);
    else
      cholesky_->solve(r_, direction_);
    direction_ = -direction_;
    return direction_.allFinite() ? NewtonStatus::converged : NewtonStatus::singular;
  };
  if (same_tangent(weights, p.shift)) return solve();
  // The loads' own slopes first; if they spoil definiteness, without them.
  for (const bool with_loads : {true, false}) {
    if (only_laws_vary_) {
      assembler.linear_values(weights, values_);
      for (std::size_t j = 0; j < slopes_.size(); ++j) {
        const ScalarTerm& term = system_.scalars()[j];
        std::size_t s = 0;
        for (const Entry& row : term.z)
          for (const Entry& col : term.z) values_[term.slots[s++]] += slopes_[j] * row.coeff * col.coeff;
      }
    } else {
      assembler.tangent_values(weights, z_, v_, history, with_loads && !p.loads, values_);
    }
    if (p.shift != 0.0) values_ += p.shift * system_.mass_values();
    ++factorizations_;
    const FactorStatus status =
        lu_ ? lu_->factorize(system_.pattern(), values_) : cholesky_->factorize(system_.pattern(), values_);
    tangent_kept_ = status == FactorStatus::success;
    if (tangent_kept_) return solve();
    if (lu_ || only_laws_vary_) break;
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
    for (std::size_t j = 0; j < inputs_.size(); ++j) {
      const ScalarTerm& term = system_.scalars()[j];
      double rate = 0.0;
      for (const Entry& e : term.z) rate += p.kappa_z * e.coeff * direction_[e.index];
      if (rate == 0.0) continue;
      const double x = inputs_[j].x;
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
