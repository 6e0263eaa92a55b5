#pragma once
/// Order content of every load at a steady speed, where nothing deviates:
///
///   p(phi) = mean + Re sum_o c_o exp(i o phi),   c_o = (2 / P) int p exp(-i o phi) dphi over its period P
///
/// phi: angle of the reference shaft; o: per revolution of it. A load of a node of the ratio n that repeats
/// with the angle T of its node has the orders m 2 pi |n| / T. Tables are integrated exactly (they are straight
/// between knots: c_o = -(2 / (P o^2)) sum of the changes of slope times exp(-i o phi) at the knots); others are
/// taken at N even angles, N doubled until the content settles. A load that does not follow the speed is
/// evaluated once.
///
/// With it the means of the load's slopes, by which it acts as a spring and a damper: dp/dtheta, dp/dtheta'.
/// How the slopes vary over the cycle is left out (tables: their mean slope is 0).
///
/// Refused, all at once: loads that depend on the time beside the angle, and loads that do not repeat within
/// kMostTurns turns of their node. LoadHarmonics does what this does about a motion that deviates.
#include <drev/core/error.hpp>
#include <drev/core/system.hpp>

#include <complex>
#include <vector>

namespace drev {

class OrderContent {
 public:
  static constexpr int kMostTurns = 20;

  struct Content {
    int node = 0;
    double mean = 0.0;                             ///< N m (or N)
    double angle_slope = 0.0, speed_slope = 0.0;   ///< means over the cycle [N m/rad], [N m s/rad]
    std::vector<std::complex<double>> amplitudes;  ///< of the orders asked for
    double rms = 0.0;                              ///< of all that alternates
    double left_out = 0.0;                         ///< rms of what is in none of the orders
  };

  /// orders: > 0. What cannot be taken goes to findings.
  OrderContent(const System& system, std::vector<double> orders, std::vector<Finding>& findings);
  /// One for each load on an unknown. speed: of the reference shaft, with its sign [rad/s].
  const std::vector<Content>& at(double speed);
  /// damping -= mean dp/dtheta', stiffness -= mean dp/dtheta of all loads at the speed, on the pattern; null: not
  /// wanted.
  void add_slopes(double speed, Vector* damping, Vector* stiffness);
  const std::vector<const LoadTerm*>& loads() const { return loads_; }
  bool follows_speed() const { return follows_speed_; }

 private:
  struct Source {
    double turns = 1.0;  // of its node, in which it repeats
    bool constant = false, follows_speed = false, known = false;
    bool by_angle = false;  // a deviation acts as the nominal angle does
    int samples = 0;        // that its content has settled with; 0: not known yet
    /// Of each curve of a load that says its torque as curves scaled by the speed (SpeedScaledLoad), once found.
    std::vector<Content> curves;
    Eigen::MatrixXd products;  // means of the products of two curves, without their means
  };
  Content of_table(const LoadTerm& term) const;
  Content of_samples(const LoadTerm& term, Source& source, double speed) const;
  Content of_curves(const LoadTerm& term, Source& source, double speed) const;
  void pick(const std::vector<std::complex<double>>& lines, double spacing, bool forward,
            Content& content) const;

  const System& system_;
  std::vector<double> orders_;
  std::vector<const LoadTerm*> loads_;
  std::vector<Source> sources_;
  std::vector<Content> content_;
  bool follows_speed_ = false;
};

/// -1 where the reference shaft turns backwards, else 1.
double reference_direction(const System& system);

}  // namespace drev
