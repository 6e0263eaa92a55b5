#pragma once
/// Newton on the contact forces alone. With the linear part factored once (S a = rhs - c B y, W = S^-1 B,
/// G = B^T W) the step is an m x m problem for the m laws' forces lambda:
///
///   lambda_j = y_j(x_j, x_j'),  x = x_free - kappa_x G lambda,  x' = x'_free - kappa_v G lambda
///
/// (Woodbury). Its potential is strictly convex for non-decreasing laws, so Newton with the exact line
/// search converges from any start; without it, three meshes in a chain can cycle for ever.
#include <drev/core/assembler.hpp>
#include <drev/solvers/contact/newton_options.hpp>

#include <Eigen/Core>

#include "solvers/contact/newton_result.hpp"

namespace drev {

/// Swaps `own` with the vector that is there, which takes its size first.
template <class T>
void hand_over(std::vector<T>& own, std::vector<T>& there) {
  if (there.size() != own.size()) there.resize(own.size());
  there.swap(own);
}

class ContactNewton {
 public:
  using Options = ContactNewtonOptions;

  ContactNewton() = default;
  ContactNewton(const System& system, Eigen::MatrixXd compliance, double kappa_x, double kappa_v);

  /// free[j]: what law j would see if all contact forces were zero (time and phase included).
  /// lambda: start in, solution out. force_scale [N or N m] > 0 makes the tolerance relative.
  NewtonResult solve(const std::vector<ScalarInput>& free, double force_scale, const Options& options,
                     Vector& lambda);

  /// Swaps the laws' inputs and responses at the last lambda evaluated with these vectors; what is left here
  /// means nothing until the next solve().
  void hand_over_laws(std::vector<ScalarInput>& inputs, std::vector<ScalarResponse>& responses) {
    hand_over(inputs_, inputs);
    hand_over(responses_, responses);
  }

 private:
  /// Evaluates the laws at lambda and returns the largest part of |y - lambda| that is no rounding; what is
  /// not above the limit is not looked at.
  double evaluate(const std::vector<ScalarInput>& free, const Vector& lambda, double limit);
  /// Newton's step from the last lambda of the solve() before, by its slopes, to what is free now.
  void expect(const std::vector<ScalarInput>& free, Vector& lambda);
  /// direction_ = (I + D G)^-1 residual_, D = kappa_x dy/dx + kappa_v dy/dx'.
  void find_direction();
  /// g_direction_ = G direction_; the potential's slope along the direction.
  double descent();
  /// Goes from lambda along the direction to where the slope, g_0 < 0 at the start, is zero.
  NewtonStatus search_line(const std::vector<ScalarInput>& free, double force_scale, double g_0,
                           Vector& lambda);

  std::vector<const ScalarForce*> laws_;
  Eigen::MatrixXd compliance_;  // G, symmetric
  double kappa_x_ = 0.0, kappa_v_ = 0.0;
  std::vector<ScalarInput> inputs_;
  std::vector<ScalarResponse> responses_;
  struct Slopes {
    double dy_dx, dy_dx_dot;
  };
  std::vector<Slopes> slopes_;  // of the last evaluate(), also when its responses were handed over
  std::vector<double> tangent_, x_start_, kinks_;
  struct Last {
    double x, x_dot;  // free
    double lambda;    // where the laws were evaluated last
  };
  std::vector<Last> last_;  // what the solve() before ended with
  bool converged_ = false;  // that one; residual_ and slopes_ are of its end
  Vector residual_, direction_, g_direction_, trial_;
};

}  // namespace drev
