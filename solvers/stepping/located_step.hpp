#pragma once
/// A step that ends where a law leaves its piece (contact_locator.hpp): none integrates over a kink or jump.
///
/// The length is found by repeating the step: the crossing in the step's polynomial gives the next length,
/// a step that ends before it the rest. It stops a landing distance (1e-6 of the step) before the bound; a
/// hop by the Taylor series, z + v tau + a tau^2/2, leads over it, and the motion starts again behind it. A
/// law whose force jumps is thus evaluated on one side of its jump only.
#include "solvers/stepping/contact_locator.hpp"
#include "solvers/stepping/stepper.hpp"

namespace drev {

class LocatedStep {
 public:
  LocatedStep(const System& system, Stepper& stepper) : stepper_(stepper), locator_(system) {}

  struct Result {
    NewtonResult newton;
    double h = 0.0;  ///< s, made; 0: the crossing is at hand, hop without a step
    /// The crossing that the step ends before, and the time left to it [s].
    std::optional<ContactLocator::Crossing> reached;
    double tau = 0.0;
  };

  /// As Stepper::step. Where the crossing cannot be closed in on (a graze), the step as it is.
  Result step(const EvaluatedState& from, double h, double t_new, double t_evaluate, EvaluatedState& to);
  /// Over the bound; `to` is started again. Returns the time gone by [s].
  double hop(const ContactLocator::Crossing& crossing, double tau, const EvaluatedState& from,
             EvaluatedState& to);

 private:
  Stepper& stepper_;
  ContactLocator locator_;
};

}  // namespace drev
