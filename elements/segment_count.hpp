#pragma once
/// How many segments a distributed shaft needs.
///
/// A uniform shaft in n equal segments carries a wave of frequency omega, with a phase of theta = omega
/// L/(n c) a segment, c = sqrt(G/rho), at another frequency omega (1 + error):
///
///   lumped      M = J/2 [1 0; 0 1]      2 sin(theta/2)/theta                                   - theta^2/24
///   consistent  M = J/6 [2 1; 1 2]      sqrt(6 (1 - cos theta)/(2 + cos theta))/theta          + theta^2/24
///   averaged    M = J/12 [5 1; 1 5]     sqrt(12 (1 - cos theta)/(5 + cos theta))/theta         - theta^4/480
///
/// K = k [1 -1; -1 1] in all, M the mean of the other two in the last; behind, the leading term of the error.
/// theta = pi is the shortest wave that segments hold. That is exact of shafts with free or held ends. Where
/// inertias at the ends hold a share p of the motion's kinetic energy, - p theta^2/24 comes to each (first
/// order; the end torque of a segment is off by theta^2/12 with the averaged mass).
///
/// Source: the dispersion of linear elements, e.g. K.-J. Bathe, Finite Element Procedures, 1996, section 9.3;
/// the mean of both masses: G. L. Goudreau, R. L. Taylor, Evaluation of numerical integration methods in
/// elastodynamics, Comput. Methods Appl. Mech. Eng. 2, 1973, doi:10.1016/0045-7825(73)90023-6.

namespace drev {

enum class SegmentMass { lumped, consistent, averaged };

/// c [m/s] of twist, of G [Pa] and rho [kg/m^3].
double torsional_wave_speed(double shear_modulus, double density);

/// Relative error of the frequency of a wave with phase theta [rad] a segment, 0 to pi. ends: p, 0 to 1.
double segment_frequency_error(SegmentMass mass, double theta, double ends = 0.0);

/// The least n with |error| <= accuracy of every wave up to a frequency [Hz], in a shaft of L [m] with waves
/// of c [m/s], while its ends have a share of at most `ends` of the kinetic energy (1: whatever they are).
/// accuracy: relative, 1e-12 to 0.1. Throws ModelError for values out of range, and where n would exceed a
/// distributed shaft's 10,000.
int segments_for(double length, double wave_speed, double accuracy, double up_to_Hz,
                 SegmentMass mass = SegmentMass::consistent, double ends = 0.0);

}  // namespace drev
