#pragma once
/// Order content of every load at a steady speed, where nothing deviates:
///
///   p(phi) = mean + Re sum_o c_o exp(i o phi),   c_o = (2 / P) int p exp(-i o phi) dphi over its period P
///
/// phi: angle of the reference shaft; o: per revolution of it. A load of a node of the ratio n that repeats
/// with the angle T of its node has the orders m 2 pi |n| / T. Tables are integrated exactly (they are straight
/// between knots: c_o = -(2 / (P o^2)) sum of the changes of slope times exp(-i o phi) at the knots), harmonics taken
/// as they are, curves with known knots integrated between them (Gauss, Legendre); others are taken at N even angles,
/// N doubled until the content settles. A load that does not follow the speed is evaluated once.
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

class SpeedScaledLoad;

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

  /// orders: > 0, ascending. What cannot be taken goes to findings.
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
    bool harmonics = false, table = false;  // it says itself as such
    const SpeedScaledLoad* scaled = nullptr;
    bool by_angle = false;  // a deviation acts as the nominal angle does
    int samples = 0;        // that its content has settled with; 0: not known yet
    /// Of each curve of a load that says its torque as curves scaled by the speed (SpeedScaledLoad), once found.
    std::vector<Content> curves;
    Eigen::MatrixXd products;  // means of the products of two curves, without their means
  };
  /// Of the first load of its family on a node of the same ratio; null: none.
  const Source* family_source(const LoadTerm& term) const;
  /// What its place and its answers say of a load; false: refused, which findings say.
  bool inspect(const LoadTerm& term, Source& source, std::vector<Finding>& findings) const;
  Content of_table(const LoadTerm& term) const;
  Content of_harmonics(const LoadTerm& term) const;
  Content of_samples(const LoadTerm& term, Source& source, double speed) const;
  void find_curves(std::size_t load, double speed);
  /// The curves between their knots; false: it says none.
  bool integrate_curves(const LoadTerm& term, Source& source, double speed, Eigen::Index count) const;
  /// Of a load of this spacing of its lines, to begin with.
  int fewest_samples(double spacing) const;
  /// Largest difference of mean and amplitudes, of the largest of them in `fine`.
  static double difference(const Content& coarse, const Content& fine);
  void sample_curves(const LoadTerm& term, Source& source, Eigen::Index count) const;
  void sum_curves(const LoadTerm& term, const Source& source, double speed, Content& sum) const;
  void pick(const std::vector<std::complex<double>>& lines, double spacing, bool forward,
            Content& content) const;

  const System& system_;
  std::vector<double> orders_;
  std::vector<const LoadTerm*> loads_;
  std::vector<Source> sources_;
  std::vector<Content> content_;
  double speed_ = 0.0;  // of content_; 0: none yet
  bool follows_speed_ = false;
};

/// -1 where the reference shaft turns backwards, else 1.
double reference_direction(const System& system);

}  // namespace drev
