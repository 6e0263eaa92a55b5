#pragma once
/// Threads of this process that compute blocks of a study.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "app/variants/variant_study.hpp"

namespace drev::app {

struct FoundBlock {
  std::uint64_t block = 0;
  double seconds = 0.0;  ///< time that the block took [s]
  BlockRows rows = {};
};

/// A task: blocks `first` to first + count - 1.
struct BlockTask {
  std::uint64_t first = 0, count = 0;
};

class BlockThreads {
 public:
  BlockThreads(const VariantStudy& study, int threads);
  ~BlockThreads();  ///< ends the blocks in work
  BlockThreads(const BlockThreads&) = delete;
  BlockThreads& operator=(const BlockThreads&) = delete;

  void give(BlockTask task);
  /// Whether more blocks should be given. Where blocks are short, one more for each thread is wanted besides
  /// those in work, so that no thread waits; where they are long, none, so that another process may take
  /// them.
  bool wants_more() const;
  bool idle() const;
  /// Blocks computed since the last call; waits at most `wait` for one. Rethrows what a thread threw.
  std::vector<FoundBlock> take(std::chrono::milliseconds wait);

 private:
  void compute();

  const VariantStudy& study_;
  mutable std::mutex mutex_;
  std::condition_variable given_, found_one_;
  std::deque<BlockTask> tasks_;
  std::vector<FoundBlock> found_;
  std::exception_ptr failure_;
  std::uint64_t waiting_ = 0, in_work_ = 0;  // numbers of blocks
  double seconds_ = 0.0;                     // time of a block, smoothed [s]
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace drev::app
