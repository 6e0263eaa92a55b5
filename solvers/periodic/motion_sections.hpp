#pragma once
/// Results of a periodic motion of LawBalance in sections: extremes over the cycle, means, orders, heat.
#include <drev/solvers/periodic/motion_figures.hpp>

#include <functional>

#include "solvers/periodic/law_balance.hpp"
#include "solvers/periodic/section_rows.hpp"

namespace drev {

class MotionSections {
 public:
  static constexpr int kSamples = 256;  ///< number of samples of a cycle at which two motions are compared

  explicit MotionSections(std::vector<SectionRows> sections) : sections_(std::move(sections)) {}
  const std::vector<SectionRows>& sections() const { return sections_; }

  struct Figures : MotionFigures {
    Eigen::MatrixXd samples;  ///< values at equidistant angles of the cycle, kSamples x sections
  };
  /// lines: numbers of the harmonics whose amplitudes are wanted. False: the motion cannot be found from x.
  bool find(LawBalance& balance, const Vector& x, double speed, const std::vector<int>& lines,
            Figures& figures) const;

 private:
  std::vector<SectionRows> sections_;
};

/// Largest difference of two motions over the cycle and the sections, relative to each section's largest
/// value [-].
double largest_difference(const MotionSections::Figures& a, const MotionSections::Figures& b);

}  // namespace drev
