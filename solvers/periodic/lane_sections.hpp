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
    LaneRow re, im;
  };

  /// held: unknowns that are 0.
  LaneSections(const System& system, const std::vector<SectionRows>& sections, const std::vector<bool>& held);
  struct Result {
    Number torque, twist;
    LaneRow heat;
  };
  /// From a solution z at the frequencies w. k_re, k_im: of each frequency term, what is beyond the matrices, at w
  /// with its sign.
  void find(const LaneArray& re, const LaneArray& im, const Lanes& w, const LaneArray& k_re,
            const LaneArray& k_im);
  const Result& of(std::size_t section) const { return results_[section]; }
  struct Powers {
    LaneRow input, dissipated;
  };
  /// input: w/2 Im(p conj z) summed over the unknowns [W]; dissipated: w^2/2 Re(z' C z), C on the system's pattern; one
  /// value an entry, or one a lane of each.
  Powers powers(const double* damping, const Lanes& w, const LaneArray& p_re, const LaneArray& p_im,
                const LaneArray& re, const LaneArray& im) const;
  Powers powers(const LaneRow* damping, const Lanes& w, const LaneArray& p_re, const LaneArray& p_im,
                const LaneArray& re, const LaneArray& im) const;

 private:
  // Unknowns that are not held; of each column, the place of its first entry, and entries' rows and slots.
  std::vector<int> unknowns_, outer_, inner_, slots_;
  std::vector<int> begin_, index_;
  std::vector<double> coeff_;
  std::vector<int> term_;  // of each section; -1: none
  LaneArray re_, im_;
  std::vector<Result> results_;
};

/// Values on a pattern that frequency terms add to at each lane's own frequency: those of all lanes, then
/// times[i] addition[term[i]] at each slot.
void add_at_slots(const std::vector<int>& slots, const std::vector<int>& terms,
                  const std::vector<double>& times, const LaneArray& additions, const double* common,
                  LaneRow* values);

}  // namespace drev
