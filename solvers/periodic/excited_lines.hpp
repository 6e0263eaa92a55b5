#pragma once
/// Harmonics of a cycle that loads and laws excite, and what each section answers to them with its contacts closed:
///
///   S_n z_n = p_n - sum_laws b F_n,   S_n = K + i n W C - (n W)^2 M   (contacts closed, W = w/turns)
///   a_n = |stiffness' z_n + i n W damping' z_n|   of each section
///
/// p_n: content of the loads (order_content.hpp). F_n: harmonics of each law's force at its mean deflection, which
/// are those of its transmission error and of its stiffness over the phase. Beyond the last harmonic: orders of loads that are
/// no harmonic of the cycle, each at its own frequency, and what else loads that do not state their orders leave out, at
/// the frequency of the last, with its rms times sqrt(2).
///
/// It tells how many harmonics a motion needs before any motion is known: harmonic balance with fewer shows no sign
/// of those that it does not contain, since half as many lack them, too.
#include "solvers/periodic/law_balance.hpp"
#include "solvers/periodic/section_rows.hpp"

namespace drev {

class ExcitedLines {
 public:
  /// turns, balance: as for LawBalance, which must take the system.
  ExcitedLines(const System& system, double turns, const std::string& balance,
               const std::vector<SectionRows>& sections);

  /// a_n at the speed of the reference shaft [rad/s]: row n-1 has harmonic n, the last row what is beyond; columns:
  /// sections, then laws.
  const Eigen::MatrixXd& at(double speed);
  /// The fewest harmonics beyond which no section and no law has more than this share of the rms of its vibration, at
  /// any of the speeds. More than lines(): no number is enough.
  int fewest(const std::vector<double>& speeds, double share);
  /// Sum of the amplitudes beyond a number of harmonics, of each section.
  Vector beyond(double speed, int harmonics);
  /// Largest part of the rms of a section's or law's vibration beyond a number of harmonics, over the speeds.
  double share_beyond(const std::vector<double>& speeds, int harmonics);
  /// Harmonics of more than this share of the rms of a section's vibration at any of the speeds, ascending.
  std::vector<int> excited(const std::vector<double>& speeds, double share);
  int lines() const { return lines_; }

 private:
  void find_lines();
  /// Square of each amplitude over the sum of the squares in its column; 0 where a column has rounding only.
  Eigen::MatrixXd shares(double speed);
  Eigen::MatrixXcd law_lines(double speed);

  const System& system_;
  double turns_;
  std::vector<SectionRows> rows_;  // sections, then laws
  Eigen::Index sections_ = 0;
  std::vector<Finding> none_;  // what a sweep refuses was found before
  LawBalance balance_;
  int lines_ = 0;
  std::vector<bool> stated_;    // whether a load states its orders
  std::vector<double> strays_;  // orders stated that are no harmonic of the cycle, or beyond the last
  std::optional<OrderContent> content_, stray_content_;
  std::vector<std::vector<Entry>> load_rows_;
  ComplexElimination elimination_;
  Vector stiffness_, damping_;
  double speed_ = 0.0;  // speed that amplitudes_ belongs to [rad/s]; 0: none yet
  Eigen::MatrixXd amplitudes_;
};

}  // namespace drev
