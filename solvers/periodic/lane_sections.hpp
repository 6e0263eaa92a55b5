#pragma once
/// LaneSections: the sections' rows over a solution at kLanes frequencies, and the powers of its vibration, in a
/// processor's widest vectors (core/lanes.hpp). Internal to LinearResponse.
#include <drev/core/lanes.hpp>
#include <drev/core/system.hpp>

#include <span>
#include <vector>

#include "solvers/periodic/section_rows.hpp"

namespace drev {

class LaneSections {
 public:
  /// Rows of a section, in this order.
  enum Row { stiffness, damping, twist, damper, beyond, kRows };
  struct Number {
    Lanes re{}, im{};
  };

  LaneSections(const System& system, const std::vector<SectionRows>& sections);
  /// Sums of all rows over z.
  void find(const LaneArray& re, const LaneArray& im);
  /// After find(). beyond: of the section's complex stiffness.
  Number of(std::size_t section, Row row) const {
    const std::size_t r = kRows * section + static_cast<std::size_t>(row);
    return {re_[r].v, im_[r].v};
  }

 private:
  std::vector<int> begin_, index_;
  std::vector<double> coeff_;
  LaneArray re_, im_;
};

/// input: w/2 Im(p conj z) summed over the unknowns [W]; dissipated: w^2/2 Re(z' C z), C on a pattern by columns;
/// one value an entry, or one a lane of each.
void lane_powers(const SparseMatrix& pattern, const double* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated);
void lane_powers(const SparseMatrix& pattern, const LaneRow* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated);

}  // namespace drev
