#pragma once
/// Harmonics, without aliasing, of loads that are piecewise linear in an angle (cam tables): their kinks have
/// content far above the harmonics that move the drive.
///
///   F_n = (2/T) int f exp(-i n w t) dt
///       = 1/N exp(-i n pi/N) sum_m (2m+1) (-i)^m j_m(n pi/N) sum_s mu_m(s) exp(-2 pi i n s/N)
///
/// mu_m(s): moments of f with the Legendre polynomials over cell s of N, split at the stretches' ends; by
/// exp(-i x xi) = sum (2m+1) (-i)^m j_m(x) P_m(xi) (NIST Digital Library of Mathematical Functions, 10.60.7),
/// truncated so that harmonics n <= N/4 have an error of 1e-12.
#include <drev/core/system.hpp>

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace drev {

class LoadHarmonics {
 public:
  explicit LoadHarmonics(const System& system);
  /// Places in System::loads() of the loads on unknowns that this class does not treat.
  const std::vector<int>& others() const { return others_; }
  /// Adds the harmonics to out (unknowns x (H + 1), H <= N/4). q, v: motion and rates at N equidistant times
  /// of the period 2 pi/w, unknowns x N.
  void add(double w, const Eigen::MatrixXd& q, const Eigen::MatrixXd& v, Eigen::MatrixXcd& out) const;

 private:
  void moments(int load, double w, const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
               Eigen::MatrixXd& mu) const;

  const System& system_;
  std::vector<int> taken_, others_;
  std::vector<std::vector<Entry>> rows_;  // row of the deviation of each load's node over the unknowns
};

}  // namespace drev
