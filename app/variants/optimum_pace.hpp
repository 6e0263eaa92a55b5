#pragma once
/// How far a search for an optimum is, as the part of its time that has passed: its first variants go side by side, on
/// several threads and in lockstep, and take far less time each than those that follow one after the other.
#include <chrono>
#include <cstdint>

namespace drev::app {

class OptimumPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// together: variants that are computed side by side, before all others, by so many threads; 0 threads: in lockstep
  /// too, whose gain is not known. all: variants, at most. together = 0: none is followed by others.
  OptimumPace(std::uint64_t together, std::uint64_t all, int threads, Clock::time_point start = Clock::now())
      : together_(together), all_(all), threads_(threads), start_(start) {}

  /// 0..1, with so many computed; 0 while it is not known. Behind those computed together the time of one is measured.
  double part_done(std::uint64_t computed, Clock::time_point now = Clock::now());

 private:
  std::uint64_t together_, all_;
  int threads_;
  Clock::time_point start_, alone_ = {};  // alone_: when the first of those one after the other began
};

}  // namespace drev::app
