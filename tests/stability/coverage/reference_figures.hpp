#pragma once
/// What is read off a reference run: peaks and values of all channels, contact changes, averages.
#include <complex>
#include <string>
#include <vector>

#include "tests/stability/coverage/reference_run.hpp"

namespace coverage {

struct ReferencePeak {
  Real most = 0, most_time = 0, least = 0, least_time = 0;
  Real amplitude() const { return most >= -least ? most : -least; }
  Real time() const { return most >= -least ? most_time : least_time; }
};

/// A deflection passed an edge of its gap.
struct EdgeTime {
  Real t = 0;
  std::string element;
  bool outward = false;  ///< contact made
  int flank = 0;         ///< +1: front
};

/// Everything that figures of one run are compared with.
struct ReferenceResult {
  bool failed = false;
  std::string reason;
  long steps = 0;
  std::vector<ReferencePeak> peaks;        ///< by channel
  std::vector<std::vector<Real>> samples;  ///< [channel][time]
  std::vector<EdgeTime> edges;
};

/// Runs the spec to its duration; sample times ascending.
ReferenceResult reference_result(const Spec& spec, const ReferencePrecision& precision,
                                 const std::vector<double>& sample_times);
/// The same from a state that is `moved` times the largest angles and speeds of another run off.
ReferenceResult reference_result_beside(const ReferenceResult& other, double moved, const Spec& spec,
                                        const ReferencePrecision& precision,
                                        const std::vector<double>& sample_times);

}  // namespace coverage
