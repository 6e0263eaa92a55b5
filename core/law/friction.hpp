#pragma once
/// Dry friction along a row of nodes: b^T v is the slip speed w, and lambda the torque that opposes it.
///
///   sliding    lambda = sign(w) g(t) tau(|w|)
///   stuck      w = 0 exactly, and lambda takes whatever that needs, |lambda| <= g(t) r tau(0)
///   one-way    w >= 0: sliding (overrunning) carries nothing, stuck (locked) any lambda <= 0
///   tie        w = 0 always, by any lambda
///   gear loss  bounds of lambda that follow the torque of the tie stated just before it (GearLoss)
///
/// f = b lambda stands on the left side of the equation of motion. g is the engagement, tau the sliding torque, r
/// the break-away ratio.
///
/// Source: F. Pfeiffer, Ch. Glocker, Multibody Dynamics with Unilateral Contacts, Wiley, 1996, chapter 5.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace drev {

class System;

/// What a gear between shafts 1 and 2 loses, over |w|, w the speed of shaft 1. tau_1 is the torque that shaft 1 puts in,
/// P the torque that comes out, referred to shaft 1:
///
///   shaft 1 drives    P = eta_f tau_1 - sign(w) tau_f
///   shaft 2 drives    tau_1 = eta_b (P + sign(w) tau_b)
///
/// The loss torque lambda = tau_1 - P is the larger of the two for w > 0, the lesser for w < 0, and whatever lies
/// between those two bounds at w = 0. It takes up power in every state where (1 - eta_b) tau_f + (1 - eta_f) eta_b tau_b
/// >= 0. Values are linear between the speeds and constant beyond.
struct GearLoss {
  std::vector<double> speeds{0.0};    ///< |w| [rad/s], ascending from 0
  std::vector<double> forward{1.0};   ///< eta_f [-], > 0, <= 1
  std::vector<double> backward{1.0};  ///< eta_b [-], <= 1; <= 0: no load turns shaft 2 by itself
  std::vector<double> bearing_forward{0.0}, bearing_backward{0.0};  ///< tau_f, tau_b at shaft 1 [N m], >= 0
};

class Friction {
 public:
  /// The engagement as a cubic of the time: sum terms[k] (s - t)^k [1/s^k] for s from t to the next breakpoint.
  struct Engagement {
    std::array<double, 4> terms{1.0, 0.0, 0.0, 0.0};
  };
  virtual ~Friction() = default;
  /// |slip speed| [rad/s or m/s], ascending from 0, and the sliding torque there [N m or N], >= 0: linear between
  /// the points, constant beyond the last.
  virtual const std::vector<double>& slip_speeds() const = 0;
  virtual const std::vector<double>& sliding_torques() const = 0;
  /// Largest torque of a stuck contact over that of one that begins to slide [-], >= 1.
  virtual double break_away() const { return 1.0; }
  /// >= 0; right-continuous.
  virtual Engagement engagement(double /*t*/) const { return {}; }
  /// Times at which the engagement jumps or kinks [s].
  virtual std::vector<double> breakpoints() const { return {}; }
  /// A freewheel: it locks where w would become negative.
  virtual bool one_way() const { return false; }
  /// The tie of a gear: it holds w = 0 by any torque.
  virtual bool rigid() const { return false; }
  /// Of a gear, b the speed of its shaft 1; null: friction of its own.
  virtual const GearLoss* gear_loss() const { return nullptr; }
};

/// State of a friction contact, as its channel ELEMENT.state gives it.
enum class FrictionState {
  backward = -1,  ///< sliding, w < 0
  stuck = 0,      ///< or locked
  forward = 1,    ///< sliding, w > 0; a freewheel that overruns
  open = 2        ///< not engaged
};
const char* to_text(FrictionState state);

/// What State::history holds of a friction contact, from FrictionTerm::history_begin on.
struct FrictionHistory {
  static constexpr int kTorque = 0;  ///< lambda [N m or N]
  static constexpr int kState = 1;   ///< of FrictionState
  static constexpr int kHeat = 2;    ///< J, dissipated since the start of the run
  /// Largest speed of the system so far [rad/s or m/s], which rounding of slip speeds is relative to: a train that
  /// came to rest has no speed that tells.
  static constexpr int kSpeedScale = 3;
  static constexpr int kSize = 4;
  // Of a tie, kTorque is P and kState the shaft that drives (1 or 2). Of a gear loss also:
  static constexpr int kTorqueIn = 4;   ///< tau_1 [N m]
  static constexpr int kTorqueOut = 5;  ///< that shaft 2 gets [N m]
  static constexpr int kPower = 6;      ///< loss [W]
  static int size(const Friction& friction) { return friction.gear_loss() ? 7 : kSize; }
};

/// The tie of the gear whose loss is frictions()[loss]; -1 where it is none.
int tie_of(const System& system, int loss);

/// Throws SolverError where the system has dry friction: `what` (a method or computation) does not take it.
void refuse_friction(const System& system, const std::string& what);
/// The sentence that it says, without full stop; nullopt: there is no dry friction.
std::optional<std::string> why_not_friction(const System& system, const std::string& what);

}  // namespace drev
