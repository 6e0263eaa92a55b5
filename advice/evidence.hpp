#pragma once
/// Why a simpler model does or does not do, in sentences: what the forces of the meshes did in the full run,
/// and how far its mesh frequencies are from the parametric resonances 2 w/n of its modes.
#include <drev/core/system.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <string>
#include <vector>

#include "advice/simplify.hpp"

namespace drev {

struct Advice;

/// "0.42 %", "-3.1 %".
std::string percent(double part);

class Evidence {
 public:
  explicit Evidence(const System& system);
  /// Forces of everything that has a gap: to be watched in the full run.
  const std::vector<std::string>& channels() const { return channels_; }
  const Flanks& flanks() const { return flanks_; }
  std::string of_full(const std::vector<Peak>& forces) const;
  /// Of a level that leaves out gaps, or the variation of mesh stiffness.
  std::string of_level(bool gap, bool variation, const std::vector<Peak>& forces) const;
  std::string sentence(const Advice& advice) const;

 private:
  std::string contacts(const std::vector<Peak>& forces) const;
  std::string parametric() const;

  const System& system_;
  std::vector<std::string> channels_;
  Flanks flanks_;  // at the start
};

}  // namespace drev
