#pragma once
/// Where inside a step a law leaves its piece (pieces.hpp) or its phase angle passes a knot (a jump of
/// the mesh stiffness), as the first root of the bound a + b_x x + b_v x' on the step's polynomial, isolated
/// with a certificate (roots.hpp): of two crossings in one step the first is found.
/// What is known of a deflection or angle (prescribed ends, transmission error, nominal angle) enters as the
/// polynomial of degree 5 through its values and rates at both ends and in the middle.
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <optional>

#include "solvers/stepping/step_polynomial.hpp"

namespace drev {

class ContactLocator {
 public:
  explicit ContactLocator(const System& system);

  struct Crossing {
    double s = 0.0;  ///< part of the step, 0..1
    std::size_t law = 0;
    LawBound bound = {};  ///< > 0 on the side it comes from
    bool knot = false;    ///< the bound is one of the phase angle and its rate
  };

  /// First crossing in the step, at 0 if the motion leaves a bound to the side it was not evaluated on. Moves
  /// the assembler's time.
  std::optional<Crossing> first(const StepPolynomial& motion, const EvaluatedState& from,
                                const EvaluatedState& to, Assembler& assembler) const;
  /// First crossing if the accelerations at a point stayed: z + v t + a t^2/2, up to h.
  std::optional<Crossing> predict(const EvaluatedState& point, double h) const;
  /// The bound's value, > 0 on the side it comes from, and its rate.
  std::pair<double, double> distance(const Crossing& c, const EvaluatedState& point) const;

 private:
  using Coefficients = StepPolynomial::Coefficients;
  struct Law {
    std::size_t index;  // place in System::scalars()
    std::vector<LawPiece> pieces;
  };
  /// Deflection x or phase angle of a law, with its rate.
  struct Value {
    double value = 0.0, rate = 0.0;
  };
  Value angle(const ScalarTerm& term, const State& state, double angle) const;
  /// x'' of a law.
  double acceleration(const ScalarTerm& term, const State& state) const;
  /// x: its deflection over a step of h seconds from this input.
  std::optional<Crossing> first_of_law(const Law& law, const ScalarInput& from, const Coefficients& x,
                                       double h) const;
  std::optional<Crossing> first_knot(std::size_t law, const Coefficients& angle) const;
  Coefficients deflection(std::size_t law, const StepPolynomial& motion, const EvaluatedState& from,
                          const EvaluatedState& to, Assembler& assembler) const;
  Coefficients phase(std::size_t law, const StepPolynomial& motion, const EvaluatedState& from,
                     const EvaluatedState& to, Assembler& assembler) const;
  std::vector<Entry> of_phase(const ScalarTerm& term) const;

  const System& system_;
  std::vector<Law> laws_;            // of more than one piece
  std::vector<std::size_t> phased_;  // laws that may have knots
  Vector zero_;
};

}  // namespace drev
