#pragma once
/// LaneSections: the right side from the loads' amplitudes, the sections' torques and twists from a solution, and the
/// powers of its vibration, at several sets of kLanes frequencies (solvers/linear/lane_elimination.hpp: row i of set s
/// is at i kLaneSets + s), in the widest vectors of the processor. Internal to LinearResponse.
#include <drev/core/lanes.hpp>
#include <drev/core/system.hpp>

#include <complex>
#include <vector>

#include "solvers/linear/lane_elimination.hpp"
#include "solvers/periodic/section_rows.hpp"

namespace drev {

class LaneSections {
 public:
  static constexpr int kFrequencies = kLaneSets * kLanes;  ///< largest number of frequencies
  /// Rows of a section, in this order.
  enum Row { twist, stiffness, damping, damper, beyond, kRows };
  /// Right side and solution, a row for each unknown, and the frequencies.
  struct Motion {
    const LaneRow *p_re, *p_im, *re, *im, *w;
  };

  /// held: true for each unknown that is held at 0. loads: row of each load over the unknowns.
  LaneSections(const System& system, const std::vector<std::vector<Entry>>& loads,
               const std::vector<SectionRows>& sections, const std::vector<bool>& held);
  /// given: kFrequencies amplitudes of each load. Only rows with loads are written.
  void add_loads(int sets, const std::vector<std::complex<double>>& given, LaneRow* p_re,
                 LaneRow* p_im) const;
  /// Finds the results of a solution. k_re, k_im: the part of each frequency term's complex stiffness beyond the
  /// matrices, at w with its sign.
  void find(int sets, const Motion& motion, const LaneArray& k_re, const LaneArray& k_im);
  const std::complex<double>* torques(std::size_t section) const { return &torque_[section * kFrequencies]; }
  const std::complex<double>* twists(std::size_t section) const { return &twist_[section * kFrequencies]; }
  double heat_of(std::size_t section) const { return heat_[section]; }  ///< of all frequencies [W]
  struct Powers {
    double input = 0.0, dissipated = 0.0;
  };
  /// input: w/2 Im(p conj z), summed over the unknowns [W]; dissipated: w/2 Re(z' (w C + H) z) [W]; both summed over
  /// all frequencies.
  template <class Value>
  Powers powers(int sets, const Motion& motion, const LaneDynamics<Value>& dynamics) const;
  struct Sparse;  // rows with few entries

 private:
  // Rows: begin of each in index_ and coeff_.
  struct RowList {
    std::vector<int> begin{0}, index;
    std::vector<double> coeff;
    void add(const std::vector<Entry>& row, const std::vector<bool>& held);
  };
  // Unknowns that are not held; for each column the place of its first entry; the rows and slots of the
  // entries.
  std::vector<int> unknowns_, outer_, inner_, slots_;
  RowList rows_, loads_;
  std::vector<double> of_twist_;  // multiple of its section's twist in each row, besides its entries
  std::vector<int> loaded_;       // unknowns on which a load acts
  std::vector<int> term_;         // frequency term of each section; -1: none
  std::vector<std::complex<double>> torque_, twist_;
  std::vector<double> heat_;
};

/// Sets K and H of each lane: K = common, plus times[i] re[terms[i]] at slots[i], and H = times[i] im[terms[i]] there.
void spread_at_slots(int sets, const std::vector<int>& slots, const std::vector<int>& terms,
                     const std::vector<double>& times, const LaneArray& re, const LaneArray& im,
                     const Vector& common, LaneArray& k, LaneArray& h);

}  // namespace drev
