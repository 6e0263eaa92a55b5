#pragma once
/// Loads that are looked up all at once, in place of a call each: TableLoads and KnottedLoads.
///
/// TableLoads: loads that are periodic tables of even spacing (LoadTable::evenly_spaced), all at once, in
/// constant time and without calls. Entry e puts the torque coeff table(w + gain z[unknown]) on its unknown,
/// w = ratio phi + phase.
///
///   table(u) = v_i + (u < u_i ? s_{i-1} : s_i) (u - u_i),   i = the knot nearest to u
///
/// u is the argument modulo the period. A knot may lie off its even place by a quarter of the spacing
/// (angles written down with a few digits): the nearest place still belongs to it, and to it alone.
///
/// KnottedLoads: loads that say their knots and curves (KnottedLoad), all at once and, between two knots, without calls.
/// Entry e puts on its place the torque
///
///   coeff (P(theta) S(theta) + G(theta) w^2),   theta = ratio phi + gain z[place],   w = ratio phi' + gain v[place]
///
/// P: the cubic that holds about theta. S, G: polynomials in cells of the angle (curve_cells.hpp), off by rounding. An
/// entry keeps its cubic and its cell until the angle leaves them. Where P follows a speed that is not steady, the load
/// is called.
#include <drev/core/load_table.hpp>

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace drev {

class CurveCells;
class KnottedLoad;
class Load;
struct MotionPoint;

class TableLoads {
 public:
  /// unknown: its place in what look_up() and add_to() are given, which may go on behind the unknowns with
  /// a system's loaded rows. gain: coeff where the load follows the motion, else 0. Equal tables are kept
  /// once.
  void add(const LoadTable& table, int unknown, double coeff, double ratio, double gain);
  int size() const { return static_cast<int>(unknown_.size()); }

  /// What was looked up, and about which knots: an entry keeps its knot until the argument leaves it. Two
  /// looks at the same arguments differ by rounding at most.
  struct Values {
    explicit Values(const TableLoads& loads);
    std::vector<double> torque;  ///< N m or N
    double steepest = 0.0;  ///< largest coeff gain |slope| [N m/rad], of both segments at each nearest knot

   private:
    friend class TableLoads;
    std::vector<double> nominal, from_knot, origin, value, left, right;
  };
  /// Sets the nominal angle phi [rad] of the reference shaft.
  void set_nominal(double phi, Values& values) const;
  /// Torques and steepness at z; NaN where that is not finite.
  void look_up(const double* z, Values& values) const;
  /// The knot nearest to an angle = ratio phi + gain z of entry e: at a distance d from the knot's angle the
  /// torque is value + (d < 0 ? left : right) d, as far as the next knot on either side.
  struct Nearest {
    double angle, value, left, right;  ///< rad, N m, N m/rad
  };
  Nearest nearest(int e, double angle) const;
  /// p[unknown] += torque.
  void add_to(const Values& values, double* p) const;

 private:
  struct Knot {
    double argument;            // less that of knot 0
    double value, left, right;  // slopes on both sides
    bool operator==(const Knot&) const = default;
  };
  Nearest find_knot(int e, double argument) const;
  std::vector<Knot> knots_;
  std::map<const double*, int> begin_of_;  // first knot of a table in knots_, by the array of its values
  // Of the entries; begin: of its table in knots_.
  std::vector<double> coeff_, ratio_, gain_, offset_, period_, inverse_period_, inverse_spacing_;
  std::vector<int> unknown_, begin_, count_;
};

class KnottedLoads {
 public:
  /// place: in what look_up() and add_to() are given. False: the load says no knots, or curves without a period; it is
  /// to be called.
  bool add(const Load& load, int place, double coeff, double ratio);
  int size() const { return static_cast<int>(entries_.size()); }
  /// S and G of a load that was added; null for any other.
  std::shared_ptr<const CurveCells> curves_of(const Load& load) const;

  /// What was looked up, and about which knots.
  struct Values {
    explicit Values(const KnottedLoads& loads);
    std::vector<double> torque;  ///< N m (or N), of the entries, then of empty lanes
    /// Largest coeff gain |slope| by angle [N m/rad] and by speed [N m s/rad], on the present side of each knot.
    double steepest = 0.0, steepest_by_speed = 0.0;

   private:
    friend class KnottedLoads;
    double t = 0.0;
    bool any_called = false;
    std::vector<char> called;
    std::vector<int> place;
    std::vector<double> nominal_angle, nominal_speed, gain, coeff;
    std::vector<double> angle, speed;   // where the tables are looked up [rad, rad/s]
    std::vector<double> low, high;      // angles for which the following hold; of one that is called, none
    std::vector<double> about, centre;  // of the cubic, of the cell [rad]
    std::vector<double> cubic, factor, by_speed;  // terms, by groups of lanes, degree by degree
  };
  /// Moves to a time t [s] and the reference shaft's motion then.
  void set_nominal(double t, const MotionPoint& nominal, Values& values) const;
  /// Torques and steepness at z, v; NaN where that is not finite.
  void look_up(const double* z, const double* v, Values& values) const;
  /// p[place] += torque.
  void add_to(const Values& values, double* p) const;

 private:
  struct Entry {
    const Load* load;
    const KnottedLoad* knots;
    std::shared_ptr<const CurveCells> curves;
    int place;
    double coeff, ratio, gain;
  };
  void take_piece(std::size_t e, Values& values) const;
  void call(Values& values) const;
  std::vector<Entry> entries_;
};

}  // namespace drev
