#pragma once
/// The suite's own model of a Spec: forces written from the formulas of docs/catalogue.md and docs/theory.md as
/// Taylor series in extended precision, between events. Shares no code with drev.
///
/// Every law is one analytic formula as long as a set of guards stays positive: flanks' edges, where dampers let
/// go or are limited, knots of tables, jumps of stiffness. `pass` takes the model over a guard.
#include <string>
#include <vector>

#include "tests/stability/coverage/series.hpp"
#include "tests/stability/coverage/spec.hpp"

namespace coverage {

/// Where an argument stands among knots that repeat with a period.
class KnotWalk {
 public:
  KnotWalk() = default;
  KnotWalk(const PeriodicPoints& points) : points_(points) {}  // NOLINT: implicit by intent
  bool empty() const { return points_.arguments.empty(); }
  /// On a knot: the stretch ahead of it.
  void place(Real argument, Real direction);
  void move(int by);
  Real low() const { return knot(segment_); }
  Real high() const { return knot(segment_ + 1); }
  Real value_at_low() const { return points_.values[index(segment_)]; }
  Real slope() const;
  int segment() const { return segment_; }

 private:
  std::size_t index(int i) const { return static_cast<std::size_t>(i) % points_.arguments.size(); }
  Real knot(int i) const;
  PeriodicPoints points_;
  long turn_ = 0;
  int segment_ = 0;
};

/// A function that stays positive while the present formulas hold.
struct Guard {
  enum class Of { mesh_edge, mesh_deep, mesh_free, mesh_cap, mesh_stiffness, mesh_error, polyline, load };
  Of of = Of::load;
  int index = 0;  ///< of the mesh, polyline or load
  int side = 0;   ///< -1: the lower end, +1: the upper end (of gap, stretch or segment)
  Poly g;
  bool fresh = false;  ///< it was passed at the step's start, where it is zero
};

struct ChannelId {
  enum class Kind {
    angle,
    speed,
    acceleration,
    twist,
    shaft_torque,
    dashpot_torque,
    spring_torque,
    mesh_force,
    mesh_deflection,
    gear_torque,
    polyline_torque,
    polyline_deflection,
    reaction,
    load
  };
  Kind kind = Kind::angle;
  int index = 0, second = 0;
  std::string name = {};  ///< as drev names it
};
const char* to_text(ChannelId::Kind kind);

class ReferenceModel {
 public:
  explicit ReferenceModel(const Spec& spec);

  const Spec& spec() const { return spec_; }
  const std::vector<ChannelId>& channels() const { return channels_; }
  int unknowns() const { return static_cast<int>(mass_.size()); }

  /// The state: deviations and rates of the unknowns.
  Real t = 0;
  std::vector<Real> z, v;

  /// Series of all motions and forces about the present state, forces to this degree.
  void expand(int degree);
  int degree() const { return degree_; }
  const Series& motion(int unknown) const { return z_[at(unknown)]; }
  /// Transmission errors, stiffnesses and loads: what the motion need not show.
  std::vector<const Series*> known_series() const;
  Poly channel(const ChannelId& id) const;
  /// The guards of the present formulas; of the series expanded last.
  std::vector<Guard> guards() const;
  /// The next time at which a load's or the nominal motion's formula changes.
  Real next_breakpoint() const;
  /// State and time at the end of a step of length s; exactly at `time` where given.
  void advance(Real s, const Real* time = nullptr);
  /// Formulas after a guard has come to zero; after a breakpoint of time: settle().
  void pass(const Guard& guard);
  void settle();
  /// The step ended at no event.
  void clear_passed() { any_passed_ = false; }
  /// In contact, of mesh or polyline with a gap: -1, 0 (apart), +1.
  int mesh_side(int mesh) const { return meshes_[at(mesh)].side; }
  int segment(int polyline) const { return polylines_[at(polyline)].segment; }
  /// Gaps in x of a polyline, as {low, high}; none: low >= high.
  struct Gap {
    Real low = 0, high = 0;
  };
  Gap polyline_gap(int polyline) const;

 private:
  struct MeshState {
    KnotWalk stiffness, error;
    int side = 0;
    bool deep = false, free = false, capped = false;
    Series e, x, rate, k, y, p, phase, error_angle;
    std::vector<Series> wave_angles;
    std::vector<Rotation> waves, error_waves;
  };
  struct LoadState {
    KnotWalk table;
    Series torque, angle;
    std::vector<Series> wave_angles;
    std::vector<Rotation> waves;
  };
  struct PolylineState {
    int segment = 0;
    Series x, rate, y;
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void find_groups();
  void find_ratios();
  void list_channels();
  Series nominal() const;
  void expand_error(MeshState& s, const Mesh& m, int degree);
  void expand_known_load(LoadState& s, const Load& l, int degree);
  void add_linear(int k);
  void add_mesh(const Mesh& m, MeshState& s, int k);
  void add_polyline(const Polyline& p, PolylineState& s, int k);
  void add_load(const Load& l, LoadState& s, int k);
  Real mesh_force(const Mesh& m, MeshState& s, int k) const;
  static Real reference_penetration(const Mesh& m);
  void settle_mesh(std::size_t i, bool start);
  Real angle_now(int node) const;
  Real rate_now(int node) const;
  Poly sum_of_residuals(const std::vector<bool>& nodes, int unit) const;
  Poly poly(const Series& s) const { return {s, degree_}; }

  Spec spec_;
  std::vector<int> unknown_;  // of a node; -1: prescribed
  std::vector<Real> factor_;  // q_node = factor z_unknown
  std::vector<int> root_;     // of the node's group
  std::vector<Real> ratio_;   // nominal
  std::vector<Real> mass_;
  std::vector<ChannelId> channels_;
  int degree_ = 0;
  Series phi_;
  std::vector<Series> z_, q_, rate_, force_, residual_;
  std::vector<MeshState> meshes_;
  std::vector<PolylineState> polylines_;
  std::vector<LoadState> loads_;
  Guard passed_;
  bool any_passed_ = false;
};

}  // namespace coverage
