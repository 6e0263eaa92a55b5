#pragma once
/// LawOffsets: the known offsets of laws (transmission error at the nominal angle) as polynomials over a step.
#include <drev/core/system.hpp>

#include <optional>
#include <vector>

namespace drev {

class TaylorSeries;

class LawOffsets {
 public:
  explicit LawOffsets(const System& system);

  /// Over h seconds from t on, through the nodes of Gauss's rule. Returns what the polynomials may be off by, relative to
  /// the deflections.
  double expand(const TaylorSeries& series, double t, double h);
  /// Series of the law's known offset, - e(s); empty where it has none. law: of System::scalars().
  const std::vector<double>& offset(int law) const { return offsets_[idx(law)]; }
  /// No law has one in this step.
  bool none() const {
    for (const std::size_t j : phased_)
      if (!offsets_[j].empty()) return false;
    return true;
  }
  /// The first time in (t, end) at which the offset of a law has a knot: a step must end there.
  std::optional<double> next_break(double t, double end) const;

 private:
  const System& system_;
  std::vector<std::size_t> phased_;  // laws that follow a node's phase
  std::vector<std::vector<double>> offsets_;
};

}  // namespace drev
