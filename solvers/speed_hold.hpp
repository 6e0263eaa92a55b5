#pragma once
/// SpeedHold: keeps the mean speed of freely floating parts in a run over cycles. Internal to runs of sweeps.
///
/// The mean torque on such a part rarely balances: a train with a cylinder that misfires slows down, and a run at
/// 1,500 rpm is soon one at 1,100 rpm. What a sweep states at a speed is the motion at that speed: a constant torque
/// balances the part, at the node that is given for that, else along its rigid-body motion r (mean_equilibrium.hpp), in
/// proportion to the inertias, where it changes no twist: seen from the part, it is the acceleration that it stands for.
/// The torque b is found from cycle to cycle, and after each the part is set back along r:
///
///   q = r' M z / J, w = r' M v / J, J = r' M r       d, dw: what q and w change by in the cycle of period T
///   b -= J dw / (2 T)
///   z -= r d,   w -> w0 - d/T: with the same torque the next cycle ends where it began
///
/// L = J dw / T - b is the mean torque that is left over without b. Without b the speed would run up or down by dw in
/// each cycle, which loads that follow the speed would feel.
#include <drev/core/state.hpp>
#include <drev/core/system.hpp>

#include <optional>
#include <vector>

namespace drev {

class MeanEquilibrium;

/// A part that floats freely. rigid is empty for one that does not turn with the reference shaft: it is left alone.
struct FloatingPart {
  Vector rigid;
  std::vector<Entry> balance;  ///< row of the node that balances it; empty: all of it by its inertia
};
std::vector<FloatingPart> floating_parts_of(const System& system, const MeanEquilibrium& mean);

class SpeedHold {
 public:
  /// system: at a constant speed [rad/s]; lives as long as this.
  SpeedHold(const System& system, std::vector<FloatingPart> parts);
  /// The system with the torques that balance its parts now.
  const System& system() const { return balanced_ ? *balanced_ : system_; }
  void begin_cycle(const State& state);
  /// Sets the parts back. Returns L of each, referred to the reference shaft [N m]; 0 where it is not above what the error of a
  /// run of this relative tolerance makes of it.
  Vector end_cycle(State& state, double period, double tolerance);

 private:
  struct Part {
    FloatingPart of;
    Vector momentum;  // M r / J
    double inertia = 0.0, moves = 0.0, torque = 0.0;
    double angle = 0.0, rate = 0.0;  // q and w where the cycle began
  };
  const System& system_;
  double speed_;
  std::vector<Part> parts_;
  std::optional<System> balanced_;
};

}  // namespace drev
