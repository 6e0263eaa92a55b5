#pragma once
/// Largest and smallest value of channels over all accepted steps, with their times.
#include <vector>

#include "core/channel.hpp"
#include "solvers/observer.hpp"

namespace drev {

struct Peak {
  double max = 0.0, max_time = 0.0;  ///< channel's unit, s
  double min = 0.0, min_time = 0.0;
  double amplitude() const { return std::max(max, -min); }  ///< largest |value|
  double time() const { return max >= -min ? max_time : min_time; }
};

class Peaks final : public Observer {
 public:
  explicit Peaks(std::vector<Channel> channels)
      : channels_(std::move(channels)), peaks_(channels_.size()) {}

  void start(const Assembler& assembler, const StepPoint& point) override;
  void step(const Assembler& assembler, const StepPoint& from, const StepPoint& to) override;

  const std::vector<Channel>& channels() const { return channels_; }
  const std::vector<Peak>& peaks() const { return peaks_; }
  /// Channel of the largest amplitude.
  std::size_t largest() const;

 private:
  std::vector<Channel> channels_;
  std::vector<Peak> peaks_;
};

}  // namespace drev
