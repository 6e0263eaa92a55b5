#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>

#include "solvers/contact/sparse_newton.hpp"

namespace drev {

namespace {

/// Of the largest K_ii / M_ii: keeps the tangent definite while a contact is open. It only shapes Newton's
/// direction; the residual and so the answer do not contain it.
constexpr double kShift = 1e-10;
constexpr int kMeanSamples = 720;  // samples of the loads over the time that their mean is of

}  // namespace

StaticSolver::StaticSolver(const System& system)
    : system_(system),
      assembler_(std::make_unique<Assembler>(system)),
      newton_(std::make_unique<SparseNewton>(system)) {
  refuse_friction(system, "the static equilibrium");
  refuse_controllers(system, "the static equilibrium");
  const std::vector<std::string> floating = system.floating_parts(Contact::closed);
  if (!floating.empty()) {
    std::string names;
    for (const std::string& name : floating) names += (names.empty() ? "" : ", ") + name;
    throw SolverError(system.name() + ": no static equilibrium: " + std::to_string(floating.size()) +
                      " part(s) of the model float freely (with " + names +
                      "); hold a node of each or tie it to ground");
  }
  zero_ = Vector::Zero(system.size());
  start_ = zero_;
  if (system.scalars().empty() && system.generals().empty()) return;
  Vector closed;
  assembler_->contact_values({0.0, 0.0, 1.0}, Contact::closed, closed);
  const SparseMatrix& pattern = system.pattern();
  for (int k = 0; k < pattern.cols(); ++k)
    for (int s = pattern.outerIndexPtr()[k]; s < pattern.outerIndexPtr()[k + 1]; ++s)
      if (pattern.innerIndexPtr()[s] == k)
        shift_ = std::max(shift_, kShift * closed[s] / system.mass_values()[s]);
}

StaticSolver::~StaticSolver() = default;

Vector StaticSolver::mean_loads(double t, double length) {
  Vector mean = zero_, p(zero_.size());
  for (int i = 0; i < kMeanSamples; ++i) {
    assembler_->set_time_ahead(t, length * i / kMeanSamples);
    assembler_->external(zero_, zero_, p);
    mean += p / kMeanSamples;
  }
  assembler_->set_time(t);
  return mean;
}

StaticResult StaticSolver::solve(const StaticOptions& options) {
  const bool moving = options.mean_over > 0.0;
  Vector mean;
  if (moving) {
    mean = mean_loads(options.t, options.mean_over);
  } else {
    assembler_->set_time(options.t);
    assembler_->stand_at_angle(options.nominal_angle);
  }
  StaticResult result;
  result.state = State::initial(system_, options.t);
  result.state.v.setZero();
  const Vector history = result.state.history;
  const SparseNewtonProblem problem{.mu = 0.0,
                                    .phi = 1.0,
                                    .kappa_z = 1.0,
                                    .kappa_v = 0.0,
                                    .z_0 = &zero_,
                                    .v_0 = &zero_,
                                    .r_0 = nullptr,
                                    .history = &history,
                                    .loads = moving ? &mean : nullptr,
                                    .shift = shift_};
  const NewtonResult newton =
      newton_->solve(*assembler_, problem, options.newton, start_, result.state.history);
  if (newton.status != NewtonStatus::converged) {
    start_ = zero_;
    throw SolverError(system_.name() + ": no static equilibrium found " +
                      (moving ? "under the mean loads"
                              : "at the nominal angle " + to_text(options.nominal_angle) + " rad") +
                      ": " + to_text(newton.status));
  }
  result.state.z = start_;
  result.iterations = newton.iterations;
  return result;
}

StaticResult solve_static(const System& system, const StaticOptions& options) {
  return StaticSolver(system).solve(options);
}

std::vector<Peak> static_sweep(const System& system, const std::vector<Channel>& channels, double angle_0,
                               double angle_1, int count) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/static sweep", findings);
  check.finite("angle_0", angle_0, "rad");
  check.finite("angle_1", angle_1, "rad");
  check.within("count", count, 1, 1e7, "");
  if (!findings.empty()) throw ModelError(findings);
  StaticSolver solver(system);
  std::vector<Peak> peaks(channels.size());
  for (int i = 0; i <= count; ++i) {
    const double angle = angle_0 + (angle_1 - angle_0) * i / count;
    const StaticResult r = solver.solve({.nominal_angle = angle});
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double value = channels[c].evaluate(solver.assembler(), r.state);
      Peak& p = peaks[c];
      if (i == 0 || value > p.max) p.max = value, p.max_time = angle;
      if (i == 0 || value < p.min) p.min = value, p.min_time = angle;
    }
  }
  return peaks;
}

}  // namespace drev
