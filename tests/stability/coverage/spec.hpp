#pragma once
/// A drivetrain in plain numbers, from which both a drev model (to_drev.hpp) and the suite's own reference
/// (reference_model.hpp) are made. SI units; angles, ratios and signs as docs/conventions.md has them.
#include <string>
#include <vector>

namespace coverage {

struct Harmonic {
  double order, amplitude, phase;  ///< amplitude cos(order angle + phase)
};

/// Linear between its points and from last to first; the first is not repeated.
struct PeriodicPoints {
  std::vector<double> arguments = {}, values = {};
  double period = 0.0;
};

enum class Law { proportional, limited, contact_only, always };

struct Node {
  double inertia = 0.0;     ///< kg m^2
  bool prescribed = false;  ///< follows its nominal motion
  double angle = 0.0;       ///< deviation at the start [rad]
  double speed = 0.0;       ///< its rate [rad/s]
};

/// k (q_b - q_a) + c (q_b' - q_a'); b < 0: to ground, k q_a + c q_a'. k = 0: a dashpot.
struct Shaft {
  int a = 0, b = -1;
  double stiffness = 0.0, damping = 0.0;
};

struct Mesh {
  enum class Stiffness { constant, step, fourier, table };
  int a = 0, b = 0;
  double radius_a = 0.0, radius_b = 0.0;  ///< base radii [m]
  bool internal = false;
  int teeth = 0;  ///< of gear a; 0: nothing follows the phase
  double backlash = 0.0, damping = 0.0, reference_penetration = 0.0, phase = 0.0;
  Law law = Law::proportional;
  Stiffness kind = Stiffness::constant;
  double stiffness = 0.0;          ///< constant; single pair of a step; mean of a series [N/m]
  double both = 0.0, ratio = 0.0;  ///< step: two pairs, contact ratio
  std::vector<Harmonic> stiffness_harmonics = {};
  PeriodicPoints stiffness_table = {};
  std::vector<Harmonic> error_harmonics = {};
  PeriodicPoints error_table = {};
};

struct Gear {
  int a = 0, b = 0;
  double ratio = 1.0;  ///< omega_b/omega_a
};

struct Polyline {
  int a = 0, b = -1;
  std::vector<double> x = {}, y = {};
  double damping = 0.0;
};

struct Load {
  enum class Kind { table_in_time, harmonics_in_time, table_in_angle, harmonics_in_angle };
  Kind kind = Kind::table_in_time;
  int node = 0;
  std::vector<double> times = {}, torques = {};  ///< table_in_time
  std::vector<Harmonic> harmonics = {};          ///< order: Hz, or of the angle
  double mean = 0.0;                             ///< harmonics_in_angle
  PeriodicPoints table = {};                     ///< table_in_angle
  double phase = 0.0;
  bool actual_angle = false;  ///< else the nominal one
};

/// Of the reference shaft: omega_0 until t_0, omega_1 from t_1 on, linear between.
struct Nominal {
  int node = -1;  ///< -1: no nominal motion
  double omega_0 = 0.0, omega_1 = 0.0, t_0 = 0.0, t_1 = 0.0;
  bool runs_up() const { return omega_0 != omega_1; }
};

struct Spec {
  std::string name;
  std::string family;  ///< what the generator meant it to be
  std::vector<Node> nodes;
  std::vector<Shaft> shafts, dashpots, springs;  ///< springs: to ground
  std::vector<Mesh> meshes;
  std::vector<Gear> gears;
  std::vector<Polyline> polylines;
  std::vector<Load> loads;
  double rayleigh_mass = 0.0, rayleigh_stiffness = 0.0;
  Nominal nominal;
  double duration = 0.0;  ///< s
  double period = 0.0;    ///< s, of all loads; 0: none
};

}  // namespace coverage
