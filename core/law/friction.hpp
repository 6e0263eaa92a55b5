#pragma once
/// Dry friction along a row of nodes: b^T v is the slip speed w, and lambda the torque that opposes it.
///
///   sliding    lambda = sign(w) g(t) tau(|w|)
///   stuck      w = 0 exactly, and lambda takes whatever that needs, |lambda| <= g(t) r tau(0)
///   one-way    w >= 0: sliding (overrunning) carries nothing, stuck (locked) any lambda <= 0
///
/// f = b lambda stands on the left side of the equation of motion. g is the engagement, tau the sliding torque, r
/// the break-away ratio.
///
/// Source: F. Pfeiffer, Ch. Glocker, Multibody Dynamics with Unilateral Contacts, Wiley, 1996, chapter 5.
#include <drev/core/element.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

class System;

class Friction {
 public:
  /// The engagement and its slope [1/s]; linear between the breakpoints.
  struct Engagement {
    double value = 1.0, slope = 0.0;
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
  static constexpr int kSize = 3;
};

/// Throws SolverError where the system has dry friction: `what` (a method or computation) does not take it.
void refuse_friction(const System& system, const std::string& what);
/// The sentence that it says, without full stop; nullopt: there is no dry friction.
std::optional<std::string> why_not_friction(const System& system, const std::string& what);

}  // namespace drev
