#pragma once
/// Growth of free motion of a gear train whose meshes are always closed and whose stiffness jumps with the
/// mesh phase: M z'' + C z' + (K + sum_j k_j(t) b_j b_j') z = 0, all k_j of a common period T, constant in
/// each of `pieces` equal parts of it.
///
///   (z, v)(T) = P (z, v)(0),   P = prod exp(A_p T / pieces),   growth = ln(max |eigenvalue of P|) / T
///
/// Positive: parametric instability; without gaps nothing bounds it.
/// Source: Floquet's theorem; J. A. Richards, Analysis of Periodically Time-Varying Systems, Springer, 1983.
#include <drev/core/system.hpp>

namespace drev {

/// growth [1/s]; period [s].
double largest_floquet_exponent(const System& system, double period, int pieces);

}  // namespace drev
