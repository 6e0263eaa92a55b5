#include "solvers/run/for_all.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace drev {

std::size_t thread_count(std::size_t count, int threads) {
  const std::size_t wanted =
      threads > 0 ? static_cast<std::size_t>(threads) : std::max(1U, std::thread::hardware_concurrency());
  return std::max<std::size_t>(1, std::min(wanted, count));
}

void for_all(std::size_t count, int threads,
             const std::function<void(std::size_t i, std::size_t thread)>& task) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&](std::size_t thread) {
    for (std::size_t i; !failed && (i = next++) < count;) try {
        task(i, thread);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        failed = true;
      }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t thread = 1; thread < thread_count(count, threads); ++thread)
      others.emplace_back(work, thread);
    work(0);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace drev
