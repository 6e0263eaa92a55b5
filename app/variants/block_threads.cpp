#include "app/variants/block_threads.hpp"

#include <chrono>

namespace drev::app {

namespace {

constexpr double kShort = 0.1;  // time of a block below which it is short [s]

}  // namespace

BlockThreads::BlockThreads(const VariantStudy& study, int threads) : study_(study) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { compute(); });
}

BlockThreads::~BlockThreads() {
  {
    const std::lock_guard lock(mutex_);  // otherwise a thread that is about to wait would miss it
    stop_ = true;
  }
  given_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void BlockThreads::give(BlockTask task) {
  const std::lock_guard lock(mutex_);
  tasks_.push_back(task);
  waiting_ += task.count;
  given_.notify_all();
}

bool BlockThreads::wants_more() const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t threads = threads_.size();
  return waiting_ + in_work_ < (seconds_ < kShort && seconds_ > 0.0 ? 2 * threads : threads);
}

bool BlockThreads::idle() const {
  const std::lock_guard lock(mutex_);
  return waiting_ + in_work_ == 0 && found_.empty();
}

std::vector<FoundBlock> BlockThreads::take(std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  found_one_.wait_for(lock, wait, [this] { return !found_.empty() || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  return std::exchange(found_, {});
}

void BlockThreads::compute() {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  for (;;) {
    given_.wait(lock, [this] { return stop_ || !tasks_.empty(); });
    if (stop_) return;
    FoundBlock found{.block = tasks_.front().first++};
    if (--tasks_.front().count == 0) tasks_.pop_front();
    --waiting_, ++in_work_;
    lock.unlock();
    const Clock::time_point start = Clock::now();
    try {
      std::optional<BlockRows> rows = study_.run(found.block, [this] { return !stop_; });
      lock.lock();
      if (!rows) return;
      found.rows = std::move(*rows);
      found.seconds = std::chrono::duration<double>(Clock::now() - start).count();
      seconds_ = seconds_ == 0.0 ? found.seconds : 0.9 * seconds_ + 0.1 * found.seconds;
      found_.push_back(std::move(found));
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failure_ = std::current_exception();
      stop_ = true;
    }
    --in_work_;
    found_one_.notify_all();
  }
}

}  // namespace drev::app
