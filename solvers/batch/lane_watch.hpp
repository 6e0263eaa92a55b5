#pragma once
/// What watches kLanes variants at once: Peaks and ContactStatistics (of whole steps) in lanes.
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <array>
#include <string>
#include <vector>

#include "solvers/batch/lane_step.hpp"

namespace drev {

class LaneWatch {
 public:
  /// Throws ModelError for channels that a system has not.
  LaneWatch(const std::array<const System*, kLanes>& systems, const std::vector<std::string>& channels);

  void start(const std::vector<Assembler>& assemblers, const LanePoint& point, double t);
  /// A step from -> to of length h that ends at t, in these lanes; the assemblers stand at its end.
  void step(const std::vector<Assembler>& assemblers, const LanePoint& from, const LanePoint& to, double h,
            double t, const LaneMask& lanes);
  std::vector<Peak> peaks(int lane) const;
  std::vector<ContactRecord> contacts(int lane) const;

 private:
  struct Watched {
    std::array<Channel, kLanes> channels;
    enum class Kind { linear, force, deflection, other } kind = Kind::other;
    int law = -1;
    std::vector<int> z, v;
    LaneArray z_coeff, v_coeff;
    Extremes<LaneRow> peak;
  };
  struct Contact {
    int law = 0;
    LaneRow low, high;
    ContactTotals<LaneRow> totals;
    LaneRow largest;  // largest force of the contact at hand
    std::array<bool, kLanes> met{};
    std::array<double, kLanes> masses{};
    std::array<ContactRecord, kLanes> records;  // what is recorded of the impacts
  };
  friend struct LaneWatchKernels;
  void value(const Watched& c, const std::vector<Assembler>& assemblers, const LanePoint& point, double t,
             LaneRow& out) const;
  void cross(Contact& c, const LanePointLaws& from, const LanePointLaws& to, const LaneMask& lanes);

  std::vector<Watched> watched_;
  std::vector<Contact> contacts_;
  std::array<const System*, kLanes> systems_;
};

}  // namespace drev
