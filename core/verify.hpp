#pragma once
/// check_element(): what a sound element must satisfy, tried at random states. For elements of
/// one's own.
///
///   const CheckReport report = check_element(MyCoupling({.k = 2e4}), 2);
///   if (!report.ok()) std::cout << report.text();
///
/// Checked:
///   parameters    check() finds nothing (else nothing more is tried)
///   tangents      dy/dx, dy/dx', dy/dangle of every law, slopes of loads and general forces, and
///                 de/dangle of a transmission error, against central differences. Near a kink the
///                 one-sided differences disagree; the tangent may then be anything within that
///                 disagreement.
///   energy        dV/dx = y at x' = 0 and stored energy >= 0; it may depend on t or the angle only
///                 where varies() says so
///   passivity     dissipated power >= 0 and equal to (y(x, x') - y(x, 0)) x'
///   agreement     what is said twice, with the call: a law's pieces (force, slopes, energy and power inside
///                 each of them and on both sides of each bound; exactly one holds everywhere), kinks, gap,
///                 closed slopes, and the formula of its scale (AngleScaledForce) with pieces_scale(); a load's
///                 table, stretch, harmonics (HarmonicLoad), knots and curves (KnottedLoad), curves scaled by the
///                 speed (SpeedScaledLoad), frequencies and bounds of slopes (Load::steepest); an element's parts
///                 with describe()
///   purity        the same input gives the same bits, whatever was evaluated between
///   matrices      M, C, K symmetric and positive semi-definite
///   speed_ratio_constraints      no constant stiffness and no law sees a nominal motion n that satisfies the
///                 speed_ratio_constraints: K n = 0, b^T n = 0
///   descriptions  sizes, node numbers, ascending kinks, closed slopes finite and >= 0
/// Random numbers come from a fixed seed: the same element gives the same report anywhere.
#include <drev/core/element_interface.hpp>

#include <string>
#include <vector>

namespace drev {

/// Where to try. Magnitudes are drawn evenly over six decades below these, both signs; where a law
/// has kinks, half of the deflections are drawn around them.
struct CheckOptions {
  int samples = 400;
  double deflection = 1.0;  ///< rad or m
  double rate = 100.0;      ///< rad/s or m/s
  double angle = 20.0;      ///< rad, nominal angles
  double time = 10.0;       ///< s
  double tolerance = 1e-5;  ///< of slopes and energies, relative to their size
  unsigned seed = 1;
};

struct CheckReport {
  std::vector<std::string> failures;  ///< one line each, the first few of a kind
  bool ok() const { return failures.empty(); }
  std::string text() const;  ///< all failures, one a line
};

/// nodes: named nodes that the element is to be tried with (internal nodes are added).
CheckReport check_element(const Element& element, int nodes, const CheckOptions& options = {});

}  // namespace drev
