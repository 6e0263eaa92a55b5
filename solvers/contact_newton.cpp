#include "solvers/contact_newton.hpp"

#include <cmath>
#include <limits>

#include "solvers/line_search.hpp"

namespace drev {

namespace {
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
}

const char* to_text(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged: return "converged";
    case NewtonStatus::no_root: return "a force that jumps leaves the step without a solution";
    case NewtonStatus::too_many_steps: return "the iteration limit was reached";
    case NewtonStatus::not_finite: return "a force is not finite";
    case NewtonStatus::singular: return "the tangent is singular or not positive definite";
  }
  return "unknown";
}

ContactNewton::ContactNewton(const System& system, Eigen::MatrixXd compliance, double kappa_x,
                             double kappa_v)
    : system_(&system),
      compliance_(std::move(compliance)),
      kappa_x_(kappa_x),
      kappa_v_(kappa_v),
      inputs_(system.scalars().size()),
      responses_(system.scalars().size()),
      tangent_(compliance_.rows(), compliance_.rows()),
      lu_(compliance_.rows()),
      shift_(compliance_.rows()),
      residual_(compliance_.rows()),
      direction_(compliance_.rows()),
      g_direction_(compliance_.rows()),
      trial_(compliance_.rows()) {}

void ContactNewton::evaluate(const std::vector<ScalarInput>& free, const Vector& lambda) {
  shift_.noalias() = compliance_ * lambda;
  for (std::size_t j = 0; j < free.size(); ++j) {
    inputs_[j] = free[j];
    inputs_[j].x -= kappa_x_ * shift_[static_cast<Eigen::Index>(j)];
    inputs_[j].x_dot -= kappa_v_ * shift_[static_cast<Eigen::Index>(j)];
    responses_[j] = system_->scalars()[j].force->evaluate(inputs_[j]);
  }
}

NewtonResult ContactNewton::solve(const std::vector<ScalarInput>& free, double force_scale,
                                  const Options& options, Vector& lambda) {
  const Eigen::Index m = lambda.size();
  const double limit = options.tolerance * force_scale;
  const auto residual_at = [&](const Vector& at_lambda) {
    evaluate(free, at_lambda);
    double size = 0.0;
    for (Eigen::Index j = 0; j < m; ++j) {
      const ScalarResponse& r = responses_[at(static_cast<int>(j))];
      const ScalarInput& in = inputs_[at(static_cast<int>(j))];
      const ScalarInput& in_0 = free[at(static_cast<int>(j))];
      residual_[j] = r.y - at_lambda[j];
      // What rounding of x and x' alone does to the force of a stiff contact is no error of Newton's.
      const double rounding =
          kRounding * (std::abs(r.dy_dx) * (std::abs(in.x) + std::abs(in_0.x)) +
                       std::abs(r.dy_dx_dot) * (std::abs(in.x_dot) + std::abs(in_0.x_dot)));
      const double excess = std::abs(residual_[j]) - rounding;
      if (!(excess <= size)) size = excess;  // NaN included
    }
    return size;
  };
  double size = residual_at(lambda);
  NewtonResult result;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    if (!std::isfinite(size)) {
      result.status = NewtonStatus::not_finite;
      return result;
    }
    if (size <= limit) {
      for (Eigen::Index j = 0; j < m; ++j) lambda[j] = responses_[at(static_cast<int>(j))].y;
      return result;
    }
    // (I + D G) d = y - lambda with D = kappa_x dy/dx + kappa_v dy/dx'.
    for (Eigen::Index j = 0; j < m; ++j) {
      const ScalarResponse& r = responses_[at(static_cast<int>(j))];
      tangent_.row(j) = (kappa_x_ * r.dy_dx + kappa_v_ * r.dy_dx_dot) * compliance_.row(j);
      tangent_(j, j) += 1.0;
    }
    lu_.compute(tangent_);
    direction_ = lu_.solve(residual_);
    trial_ = lambda + direction_;
    if (!options.line_search) {
      lambda = trial_;
      size = residual_at(lambda);
      continue;
    }
    g_direction_.noalias() = compliance_ * direction_;
    const double g_0 = -g_direction_.dot(residual_);
    // The kinks that x_j(alpha) = x_j - alpha kappa_x (G d)_j runs over.
    kinks_.clear();
    for (Eigen::Index j = 0; j < m; ++j) {
      const double rate = -kappa_x_ * g_direction_[j];
      const double x = inputs_[at(static_cast<int>(j))].x;
      if (rate != 0.0)
        for (const double kink : system_->scalars()[at(static_cast<int>(j))].force->kinks())
          if ((kink - x) / rate > 0.0) kinks_.push_back((kink - x) / rate);
    }
    const double full = residual_at(trial_);
    if (full <= limit || !(g_0 < 0.0)) {
      lambda = trial_;
      size = full;
      continue;
    }
    const Vector& start = lambda;
    const auto slope = [&](double alpha) {
      trial_ = start + alpha * direction_;
      residual_at(trial_);
      return -g_direction_.dot(residual_);
    };
    const double alpha = exact_line_search(slope, g_0, kinks_);
    direction_ *= alpha;
    if (direction_.lpNorm<Eigen::Infinity>() <=
        1e-15 * std::max(force_scale, lambda.lpNorm<Eigen::Infinity>())) {
      result.status = NewtonStatus::no_root;
      return result;
    }
    lambda += direction_;
    size = residual_at(lambda);
  }
  result.status = NewtonStatus::too_many_steps;
  return result;
}

}  // namespace drev
