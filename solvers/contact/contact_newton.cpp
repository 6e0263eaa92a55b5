#include "solvers/contact/contact_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "solvers/contact/line_search.hpp"

namespace drev {

namespace {
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
}

const char* to_text(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "converged";
    case NewtonStatus::no_root:
      return "a force that jumps leaves the step without a solution";
    case NewtonStatus::too_many_steps:
      return "the iteration limit was reached";
    case NewtonStatus::not_finite:
      return "a force is not finite";
    case NewtonStatus::singular:
      return "the tangent is singular or not positive definite";
  }
  return "unknown";
}

ContactNewton::ContactNewton(const System& system, Eigen::MatrixXd compliance, double kappa_x, double kappa_v)
    : compliance_(std::move(compliance)),
      kappa_x_(kappa_x),
      kappa_v_(kappa_v),
      inputs_(system.scalars().size()),
      responses_(system.scalars().size()),
      slopes_(system.scalars().size()),
      tangent_(system.scalars().size() * system.scalars().size()),
      x_start_(system.scalars().size()),
      last_(system.scalars().size()),
      residual_(compliance_.rows()),
      direction_(compliance_.rows()),
      g_direction_(compliance_.rows()),
      trial_(compliance_.rows()) {
  for (const ScalarTerm& term : system.scalars()) laws_.push_back(term.force);
}

double ContactNewton::evaluate(const std::vector<ScalarInput>& free, const Vector& lambda, double limit) {
  const std::size_t m = laws_.size();
  const double* force = lambda.data();
  double size = 0.0;
  for (std::size_t j = 0; j < m; ++j) {
    const double* row = compliance_.data() + j * m;
    double shift = 0.0;
    for (std::size_t i = 0; i < m; ++i) shift += row[i] * force[i];
    const ScalarInput& in_0 = free[j];
    ScalarInput& in = inputs_[j];
    in.x = in_0.x - kappa_x_ * shift;
    in.x_dot = in_0.x_dot - kappa_v_ * shift;
    in.t = in_0.t;
    in.angle = in_0.angle;
    const ScalarResponse& r = *std::construct_at(&responses_[j], laws_[j]->evaluate(in));  // without a copy
    slopes_[j] = {r.dy_dx, r.dy_dx_dot};
    const double residual = residual_.data()[j] = r.y - force[j];
    if (std::abs(residual) <= limit) continue;
    // What rounding of x and x' alone does to the force of a stiff contact is no error of Newton's.
    const double rounding = kRounding * (std::abs(r.dy_dx) * (std::abs(in.x) + std::abs(in_0.x)) +
                                         std::abs(r.dy_dx_dot) * (std::abs(in.x_dot) + std::abs(in_0.x_dot)));
    const double excess = std::abs(residual) - rounding;
    if (!(excess <= size)) size = excess;  // NaN included
  }
  return size;
}

void ContactNewton::expect(const std::vector<ScalarInput>& free, Vector& lambda) {
  const std::size_t m = laws_.size();
  for (std::size_t j = 0; j < m; ++j)
    residual_.data()[j] +=
        slopes_[j].dy_dx * (free[j].x - last_[j].x) + slopes_[j].dy_dx_dot * (free[j].x_dot - last_[j].x_dot);
  find_direction();
  for (std::size_t j = 0; j < m; ++j) lambda.data()[j] = last_[j].lambda + direction_.data()[j];
}

void ContactNewton::find_direction() {
  const std::size_t m = laws_.size();
  double *a = tangent_.data(), *x = direction_.data();
  const double *g = compliance_.data(), *r = residual_.data();
  const auto slope = [this](std::size_t j) {
    return kappa_x_ * slopes_[j].dy_dx + kappa_v_ * slopes_[j].dy_dx_dot;
  };
  if (m == 2) {  // most often: two stages of gears
    const double d_0 = slope(0), d_1 = slope(1), a_00 = 1.0 + d_0 * g[0], a_01 = d_0 * g[1],
                 a_10 = d_1 * g[1], a_11 = 1.0 + d_1 * g[3], over = 1.0 / (a_00 * a_11 - a_01 * a_10);
    x[0] = over * (a_11 * r[0] - a_01 * r[1]);
    x[1] = over * (a_00 * r[1] - a_10 * r[0]);
    return;
  }
  // Gauss' elimination with partial pivoting: for a handful of rows a library's call costs several times
  // its arithmetic.
  for (std::size_t j = 0; j < m; ++j) {
    const double d = slope(j);
    for (std::size_t i = 0; i < m; ++i) a[j * m + i] = d * g[j * m + i];
    a[j * m + j] += 1.0;
    x[j] = r[j];
  }
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t pivot = k;
    for (std::size_t j = k + 1; j < m; ++j)
      if (std::abs(a[j * m + k]) > std::abs(a[pivot * m + k])) pivot = j;
    if (pivot != k) {
      std::swap_ranges(a + k * m + k, a + k * m + m, a + pivot * m + k);
      std::swap(x[k], x[pivot]);
    }
    for (std::size_t j = k + 1; j < m; ++j) {
      const double factor = a[j * m + k] / a[k * m + k];
      if (factor == 0.0) continue;
      for (std::size_t i = k + 1; i < m; ++i) a[j * m + i] -= factor * a[k * m + i];
      x[j] -= factor * x[k];
    }
  }
  for (std::size_t k = m; k-- > 0;) {
    for (std::size_t i = k + 1; i < m; ++i) x[k] -= a[k * m + i] * x[i];
    x[k] /= a[k * m + k];
  }
}

NewtonResult ContactNewton::solve(const std::vector<ScalarInput>& free, double force_scale,
                                  const Options& options, Vector& lambda) {
  const double limit = options.tolerance * force_scale;
  const std::size_t m = laws_.size();
  NewtonResult result;
  if (options.expects && converged_) {
    expect(free, lambda);
    ++result.iterations;
  }
  converged_ = false;
  double size = evaluate(free, lambda, limit);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    if (size <= limit) {
      for (std::size_t j = 0; j < m; ++j) {
        last_[j] = {free[j].x, free[j].x_dot, lambda.data()[j]};
        lambda.data()[j] = responses_[j].y;
      }
      converged_ = true;
      return result;
    }
    if (!std::isfinite(size)) {
      result.status = NewtonStatus::not_finite;
      return result;
    }
    find_direction();
    for (std::size_t j = 0; j < m; ++j) x_start_[j] = inputs_[j].x;
    const double g_0 = options.line_search ? descent() : 0.0;
    for (std::size_t j = 0; j < m; ++j) trial_.data()[j] = lambda.data()[j] + direction_.data()[j];
    size = evaluate(free, trial_, limit);
    if (size <= limit || !(g_0 < 0.0)) {
      lambda.swap(trial_);
      continue;
    }
    result.status = search_line(free, force_scale, g_0, lambda);
    if (result.status != NewtonStatus::converged) return result;
    size = evaluate(free, lambda, limit);
  }
  result.status = NewtonStatus::too_many_steps;
  return result;
}

double ContactNewton::descent() {
  const std::size_t m = laws_.size();
  double g_0 = 0.0;
  for (std::size_t j = 0; j < m; ++j) {
    double sum = 0.0;
    for (std::size_t i = 0; i < m; ++i) sum += compliance_.data()[j * m + i] * direction_.data()[i];
    g_direction_.data()[j] = sum;
    g_0 -= sum * residual_.data()[j];
  }
  return g_0;
}

NewtonStatus ContactNewton::search_line(const std::vector<ScalarInput>& free, double force_scale, double g_0,
                                        Vector& lambda) {
  // The kinks that x_j(alpha) = x_j - alpha kappa_x (G d)_j runs over.
  kinks_.clear();
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const double rate = -kappa_x_ * g_direction_.data()[j];
    if (rate != 0.0)
      for (const double kink : laws_[j]->kinks())
        if ((kink - x_start_[j]) / rate > 0.0) kinks_.push_back((kink - x_start_[j]) / rate);
  }
  const auto slope = [&](double alpha) {
    trial_ = lambda + alpha * direction_;
    evaluate(free, trial_, 0.0);
    return -g_direction_.dot(residual_);
  };
  direction_ *= exact_line_search(slope, g_0, kinks_);
  if (direction_.lpNorm<Eigen::Infinity>() <= 1e-15 * std::max(force_scale, lambda.lpNorm<Eigen::Infinity>()))
    return NewtonStatus::no_root;
  lambda += direction_;
  return NewtonStatus::converged;
}

}  // namespace drev
