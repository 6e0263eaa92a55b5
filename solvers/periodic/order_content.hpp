#pragma once
/// Order content of every load at a steady speed, where nothing deviates:
///
///   p(phi) = mean + Re sum_o c_o exp(i o phi),   c_o = (2 / P) int p exp(-i o phi) dphi over its period P
///
/// phi: angle of the reference shaft; o: order per revolution of it. A load on a node of the ratio n that
/// repeats with the angle T of its node has the orders m 2 pi |n| / T. Tables are integrated exactly (they
/// are piecewise linear: c_o = -(2 / (P o^2)) sum of the changes of slope times exp(-i o phi) at the knots).
/// Harmonics are used as they are given. Curves with known knots are integrated between them
/// (Gauss-Legendre). Other loads are sampled at N equidistant angles, with N doubled until the content of every second one is
/// the same. What a load depends on, and after how many turns it repeats, is told at the angles of LoadProbes. A load that does not depend on the speed is evaluated once; of one that is called, what it depends on is found anew
/// at each speed at which it gives other torques: a gate may open there.
///
/// The class also gives the means of the load's slopes dp/dtheta and dp/dtheta', by which the load acts as a
/// spring and a damper. The variation of the slopes over the cycle is left out (tables: their mean slope is
/// 0).
///
/// Refused, with all findings together: loads that depend on time besides the angle, and loads that do not
/// repeat within kMostTurns turns of their node. LoadHarmonics is the counterpart for a motion with
/// deviations.
#include <drev/core/error.hpp>
#include <drev/core/system.hpp>

#include <complex>
#include <vector>

#include "solvers/periodic/load_probes.hpp"

namespace drev {

class SpeedScaledLoad;

class OrderContent {
 public:
  static constexpr int kMostTurns = 20;

  struct Content {
    int node = 0;
    double mean = 0.0;                             ///< N m (or N)
    double angle_slope = 0.0, speed_slope = 0.0;   ///< mean slopes over the cycle [N m/rad], [N m s/rad]
    std::vector<std::complex<double>> amplitudes;  ///< complex amplitudes of the orders given
    double rms = 0.0;                              ///< rms of the alternating torque
    double left_out = 0.0;                         ///< rms of the part of it that is in none of the orders
  };

  /// orders: > 0, ascending. Loads that are refused are added to findings.
  OrderContent(const System& system, std::vector<double> orders, std::vector<Finding>& findings);
  /// The content of each load on an unknown. speed: signed speed of the reference shaft [rad/s]. Throws ModelError where a load
  /// depends on the time, or does not repeat, at this speed only.
  const std::vector<Content>& at(double speed);
  /// damping -= mean dp/dtheta', stiffness -= mean dp/dtheta of all loads at the speed, as values on the
  /// pattern; null if not wanted.
  void add_slopes(double speed, Vector* damping, Vector* stiffness);
  const std::vector<const LoadTerm*>& loads() const { return loads_; }
  /// Whether the slopes of a load may differ between speeds.
  bool follows_speed() const { return follows_speed_; }

 private:
  static constexpr double kWholeLine = 1e-9;
  static constexpr double kSettled = 1e-9;  // error relative to the largest amplitude (or slope) [-]
  static constexpr double kNoLine =
      1e-13;  // amplitude relative to the rms that is rounding of the transform [-]
  static constexpr int kMostSamples = 1 << 16;
  struct Source {
    double turns = 1.0;  // turns of its node in which the load repeats
    bool constant = false, known = false;
    bool changed = false;                   // by the speed last asked for
    bool called = false;                    // true: its torque and slopes may follow the speed in any way
    LoadProbes probes;                      // where it is looked at, at the speed of its content
    std::vector<double> probed;             // torques and slopes there of a load that is called
    bool harmonics = false, table = false;  // true: the load gives its harmonics, or its table
    const SpeedScaledLoad* scaled = nullptr;
    int relative = -1;            // number of the first load of its family, if that is another one
    std::vector<double> factors;  // factors of its curves at the speed last asked for; of a relative, empty
    bool by_angle = false;        // true: a deviation acts in the same way as the nominal angle
    int samples = 0;              // number of samples with which its content has converged; 0: not known yet
    /// Content of each curve of a load whose torque is a sum of curves scaled by the speed (SpeedScaledLoad).
    std::vector<Content> curves;
    Eigen::MatrixXd products;  // means of the products of two curves, without their means
  };
  /// The source of the first load of the same family on a node of the same ratio; null: none.
  const Source* family_source(const LoadTerm& term) const;
  /// Finds the properties of a load from its place and by evaluating it at the source's probes, at a speed of the reference shaft;
  /// false: refused, with findings.
  bool inspect(const LoadTerm& term, double at_speed, Source& source, std::vector<Finding>& findings) const;
  bool changes(std::size_t load, double speed, std::vector<Finding>& findings);
  Content of_table(const LoadTerm& term) const;
  Content of_harmonics(const LoadTerm& term) const;
  Content of_samples(const LoadTerm& term, Source& source, double speed) const;
  void find_curves(std::size_t load, double speed);
  /// Integrates the curves between their knots; false: the load does not give any knots.
  bool integrate_curves(const LoadTerm& term, Source& source, double speed, Eigen::Index count) const;
  /// The number of samples to begin with, for a load whose lines have this spacing [order].
  int fewest_samples(const Source& source, double spacing) const;
  /// Largest difference of mean and amplitudes, relative to the largest of them in `fine` [-].
  static double difference(const Content& coarse, const Content& fine);
  void sample_curves(const LoadTerm& term, Source& source, Eigen::Index count) const;
  void sum_curves(std::size_t load);
  void pick(const std::vector<std::complex<double>>& lines, double spacing, bool forward,
            Content& content) const;

  const System& system_;
  std::vector<double> orders_;
  std::vector<const LoadTerm*> loads_;
  std::vector<Source> sources_;
  std::vector<Content> content_;
  double speed_ = 0.0;  // speed that content_ belongs to [rad/s]; 0: none yet
  bool follows_speed_ = false;
};

/// -1 where the reference shaft turns backwards, else 1.
double reference_direction(const System& system);

}  // namespace drev
