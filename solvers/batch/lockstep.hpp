#pragma once
/// A block of up to kLanes variants run in lockstep: simulate() in lanes.
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "solvers/batch/lane_factor.hpp"
#include "solvers/batch/lane_loads.hpp"
#include "solvers/batch/lane_watch.hpp"
#include "solvers/run/stiff_twists.hpp"
#include "solvers/stepping/coarse_steps.hpp"
#include "solvers/stepping/generalized_alpha.hpp"

namespace drev {

/// What keeps runs with these options from being made in lockstep; nullopt: nothing.
std::optional<std::string> why_not_lockstep(const System& system, const TransientOptions& options);

class Lockstep {
 public:
  /// systems: 1 to kLanes of one topology with the same breakpoints, which outlive this.
  Lockstep(const std::vector<const System*>& systems, const TransientOptions& options,
           const std::vector<std::string>& channels);
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;

  /// go_on: called every 100 steps with the part done, 0..1; false interrupts.
  std::vector<VariantResult> run(const std::function<bool(double)>& go_on);

 private:
  bool alive(int lane) const { return alive_[lane] != 0; }
  void start(double t, bool first);
  void prepare(double h);
  void step(double h, double t_new, double t_evaluate);
  /// Solves for a, p and the laws at the step's end; adds the lanes that did not converge to failed.
  void solve(double h, double t_evaluate, LaneMask& failed);
  void step_alone(int lane, double h, double t_new, double t_evaluate);
  bool accept_alone(int lane, double h);
  void look_at(int lane, double h, double t_new);
  void finish_lane(int lane, double t);

  std::array<const System*, kLanes> systems_;
  std::size_t count_;
  const TransientOptions& options_;
  StepScheme scheme_;
  std::vector<VariantResult> results_;
  std::vector<std::unique_ptr<GeneralizedAlpha>> steppers_;
  std::vector<std::unique_ptr<EnergyMonitor>> monitors_;
  std::vector<Assembler> assemblers_;
  LaneMatrices matrices_;
  LaneFactor factor_;
  LaneLaws laws_;
  LaneLoads loads_;
  LaneWatch watch_;
  LanePoint now_, next_;
  LaneEnergy energy_;
  LaneValues w_;  // S^-1 B, by rows
  LaneArray known_, a_, p_before_, lambda_, values_;
  LaneForces by_;
  LaneRow force_scale_, iterations_, passes_;
  LaneMask alive_{}, grow_{};
  std::vector<CoarseSteps> coarse_;
  std::vector<StiffTwists> stiff_;
  EvaluatedState look_from_, look_to_;
  std::array<EvaluatedState, 2> points_alone_;
  EvaluatedState *from_alone_ = &points_alone_[0], *to_alone_ = &points_alone_[1];
  double t_ = 0.0, h_ = 0.0;
  long steps_ = 0, factorizations_ = 0;
};

}  // namespace drev
