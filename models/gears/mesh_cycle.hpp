#pragma once
/// MeshCycle: stiffness and transmission error of a gear pair over its mesh cycle, from its geometry.
///
///   F_i c_i(F_i) + sum_j C_ij F_j + e_i = delta  where F_i > 0,   e_i + sum_j C_ij F_j >= delta where F_i = 0
///   c_i(F) = sum over both gears of [g(t_i) + (1 - nu^2)/pi (2 ln(2 m_n/a) - nu/(1 - nu))]/E
///   a^2 = 4 F rho/pi [(1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2],   rho = t_1 t_2/T,   sum_i F_i = w
///
/// F_i: force of pair i per width along the transverse line of action; delta: approach of the rigid bores along it (the
/// loaded transmission error); C_ij: coupling of the pairs through both bodies (tooth_compliance.hpp); e_i: what pair i is
/// short of material (tip relief, pitch deviations; outside the path of contact the distance of the tip's corner from the
/// other flank, exactly). Stiffness per width: secant w/(delta - delta_0), delta_0 = min e_i the unloaded error; tangent
/// dw/ddelta. Phase 0: a pair enters at the point A, t_A = T - sqrt(r_a2^2 - r_b2^2); 1: the next one.
///
/// 1/rho = 1/t_1 + 1/t_2, with a ring 1/t_1 - 1/t_2; T is the tangents' sum or difference. A ring is held at its outside.
///
/// Helical gears: slices that do not hold each other, each at its own phase, all at one delta.
/// Limits: no friction; aligned axes; slices of a helical tooth uncoupled; contact beyond the ends of the path takes the
/// compliance of the tip and the direction of the line of action.
/// Sources: Conry & Seireg, J. Eng. Ind. 95 (1973) 1115-1122, doi:10.1115/1.3438259 (load sharing); Weber 1949 and Johnson,
/// Contact Mechanics 1985, equation 5.58 (contact); Seager, Separation of gear teeth in approach and recess, ASLE Trans. 19
/// (1976) 164-170 (contact outside the path).
#include <drev/elements/harmonic.hpp>
#include <drev/models/gears/gear_geometry.hpp>

#include <array>
#include <functional>
#include <vector>

namespace drev {

/// Linear relief of a tip: from nothing to `depth` over the last `length` of the line of action.
struct TipRelief {
  double depth = 0.0;   ///< m, normal to the flank, >= 0
  double length = 0.0;  ///< m along the line of action, > 0 where there is a depth
};

struct MeshCycleOptions {
  double load = 100e3;  ///< w, transverse force along the line of action per common width, N/m, > 0
  int points = 100;     ///< phases (i + 1/2)/points of each mesh period, 4 to 1000
  int level = 2;        ///< of the finite elements, 2 to 8, even; half of it gives the error
  /// Contact of a tip's corner before A and behind E, where deflections bring it about.
  bool corner_contact = true;
  /// The rotation of the discs under the torque alone is part of the mesh. Where shafts stand for it, take it out.
  bool windup = true;
  std::array<TipRelief, 2> tip_relief = {};
  /// Lacking material of consecutive pairs by pitch deviations of both gears, m; as many mesh periods are computed.
  std::vector<double> pitch_deviations = {};
  double overlap_ratio = kNotGiven;  ///< eps_beta in place of the geometry's
};

struct MeshPoint {
  static constexpr int kMostPairs = 5;
  double phase = 0.0;
  double t = 0.0;                      ///< of the entering pair on gear 1, m (helical: of the first slice)
  double pairs = 0.0;                  ///< that carry; helical: mean of the slices
  double secant = 0.0, tangent = 0.0;  ///< N/m per m of width
  double loaded_error = 0.0;           ///< delta, m
  double unloaded_error = 0.0;         ///< delta_0, m
  std::array<double, kMostPairs> shares{};  ///< of the load: the entering pair's, the one's before it, ...
};

/// What a cycle comes down to, each with an error estimated from a mesh of half as many cells an edge.
struct MeshFigures {
  double mean = 0.0, tangent_mean = 0.0;              ///< N/m per m of width
  double highest = 0.0, lowest = 0.0;                 ///< secant
  double error_mean = 0.0, error_peak_to_peak = 0.0;  ///< of delta, m
  double loaded_contact_ratio = 0.0;                  ///< mean number of pairs that carry
  double single_pair = 0.0;  ///< one pair alone at the pitch point, secant, N/m per m of width
};

class MeshCycle {
 public:
  /// Throws ModelError for options out of range and gears that cannot be computed, SolverError where no load is carried.
  MeshCycle(const GearPair& pair, const MeshCycleOptions& options = {});

  const MeshCycleOptions& options() const { return options_; }
  const std::vector<MeshPoint>& points() const { return points_; }
  const MeshFigures& figures() const { return figures_; }
  const MeshFigures& errors() const { return errors_; }  ///< estimated, absolute
  /// Fourier series over one mesh period (the first) without its mean: order n, amplitude in the unit of `value` (secant:
  /// N/m per m), phase rad; up to (points - 1)/2 orders.
  std::vector<Harmonic> harmonics(int count, double MeshPoint::*value = &MeshPoint::secant) const;
  int unknowns() const { return unknowns_; }  ///< of one tooth's sector of gear 1, finer mesh
  /// Force along the line of action per width [N/m] at a phase, where the gears have come nearer by `approach` [m]
  /// than where they begin to touch; 0 where it is <= 0. What w and delta - delta_0 are, for any load.
  double force(double phase, double approach) const { return force_(phase, approach); }
  /// One pair alone at t of gear 1 under w, secant, N/m per m of width.
  double single_pair(double t) const { return single_(t); }

  /// Rotation of a disc of gear under torque, as compliance along the line of action times E; what windup = false leaves out.
  static double windup(const GearPair& pair, int gear);

 private:
  MeshCycleOptions options_;
  std::vector<MeshPoint> points_;
  MeshFigures figures_, errors_;
  std::function<double(double)> single_;
  std::function<double(double, double)> force_;
  int unknowns_ = 0;
};

}  // namespace drev
