#pragma once
/// Where inside a step a law passes one of its kinks (edges of the gap among them), as the first root of the
/// step's polynomial, isolated with a certificate (polynomial.hpp): of two crossings in one step the first
/// is found. A law's known part (prescribed ends, transmission error) enters as the polynomial of degree 5
/// through its values and rates at both ends and in the middle.
#include <optional>

#include "solvers/step_point.hpp"
#include "solvers/step_polynomial.hpp"

namespace drev {

class ContactLocator {
 public:
  explicit ContactLocator(const System& system);

  struct Crossing {
    double s = 0.0;  ///< part of the step, 0..1
    std::size_t law = 0, kink = 0;
    int side = 1;    ///< it comes from: +1 x above the kink, -1 below
  };

  /// First crossing in the step, at 0 if the motion leaves a kink to the side it was not evaluated on. Moves
  /// the assembler's time.
  std::optional<Crossing> first(const StepPolynomial& motion, const StepPoint& from,
                                const StepPoint& to, Assembler& assembler) const;
  /// First crossing if the accelerations at a point stayed: z + v t + a t^2/2, up to h.
  std::optional<Crossing> predict(const StepPoint& point, double h) const;
  /// Distance of the law from the kink, > 0 on the side it comes from, and its rate.
  std::pair<double, double> distance(const Crossing& c, const StepPoint& point) const;

 private:
  std::optional<Crossing> first_of_law(std::size_t law, const StepPolynomial::Coefficients& x) const;
  StepPolynomial::Coefficients deflection(std::size_t law, const StepPolynomial& motion,
                                          const StepPoint& from, const StepPoint& to,
                                          Assembler& assembler) const;

  const System& system_;
  std::vector<std::size_t> laws_;  // that have kinks
  Vector zero_;
};

}  // namespace drev
