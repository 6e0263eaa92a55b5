#pragma once
/// LaneSections: the sections' torques and twists from a solution at kLanes frequencies, and the powers of
/// its vibration, in the widest vectors of the processor (core/lanes.hpp). Internal to LinearResponse.
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

  /// held: true for each unknown that is held at 0.
  LaneSections(const System& system, const std::vector<SectionRows>& sections, const std::vector<bool>& held);
  struct Result {
    Number torque, twist;
    LaneRow heat;
  };
  /// Results of a solution z at the frequencies w. k_re, k_im: the part of each frequency term's complex
  /// stiffness beyond the matrices, at w with its sign.
  void find(const LaneArray& re, const LaneArray& im, const Lanes& w, const LaneArray& k_re,
            const LaneArray& k_im);
  const Result& of(std::size_t section) const { return results_[section]; }
  struct Powers {
    LaneRow input, dissipated;
  };
  /// input: w/2 Im(p conj z), summed over the unknowns [W]; dissipated: w^2/2 Re(z' C z) [W]. damping: C on
  /// the system's pattern, with one value for each entry, or one for each entry and lane.
  Powers powers(const double* damping, const Lanes& w, const LaneArray& p_re, const LaneArray& p_im,
                const LaneArray& re, const LaneArray& im) const;
  Powers powers(const LaneRow* damping, const Lanes& w, const LaneArray& p_re, const LaneArray& p_im,
                const LaneArray& re, const LaneArray& im) const;

 private:
  // Unknowns that are not held; for each column the place of its first entry; the rows and slots of the
  // entries.
  std::vector<int> unknowns_, outer_, inner_, slots_;
  std::vector<int> begin_, index_;
  std::vector<double> coeff_;
  std::vector<int> term_;  // frequency term of each section; -1: none
  LaneArray re_, im_;
  std::vector<Result> results_;
};

/// Sets the values on a pattern to which frequency terms contribute at each lane's own frequency: the values
/// common to all lanes, plus times[i] additions[terms[i]] at slots[i].
void add_at_slots(const std::vector<int>& slots, const std::vector<int>& terms,
                  const std::vector<double>& times, const LaneArray& additions, const double* common,
                  LaneRow* values);

}  // namespace drev
