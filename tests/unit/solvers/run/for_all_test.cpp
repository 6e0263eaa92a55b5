// Independent tasks side by side: each once, thread numbers in range, the first exception ends them.
#include "solvers/run/for_all.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("for_all: each task once, in no more threads than asked for") {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size_t{1000}})
    for (const int threads : {0, 1, 3}) {
      std::vector<std::atomic<int>> calls(count);
      std::atomic<std::size_t> highest = 0;
      for_all(count, threads, [&](std::size_t i, std::size_t thread) {
        ++calls[i];
        for (std::size_t seen = highest; thread > seen && !highest.compare_exchange_weak(seen, thread);) {
        }
      });
      int others = 0;
      for (const std::atomic<int>& n : calls) others += n != 1;
      CHECK(others == 0);
      CHECK(highest < thread_count(count, threads));
    }
  CHECK(thread_count(1000, 3) == 3);
  CHECK(thread_count(2, 3) == 2);
  CHECK(thread_count(0, 3) == 1);
  CHECK(thread_count(1000) >= 1);
}

TEST_CASE("for_all: an exception ends the tasks and is thrown") {
  for (const int threads : {1, 4}) {
    std::atomic<int> begun = 0;
    const auto task = [&](std::size_t i, std::size_t) {
      ++begun;
      if (i == 2) throw std::runtime_error("task 2");
      // On a busy machine the others would all be done before that one goes on.
      if (threads > 1) std::this_thread::sleep_for(std::chrono::microseconds(1));
    };
    CHECK_THROWS_WITH(for_all(100000, threads, task), "task 2");
    CHECK(begun < 100000);
    if (threads == 1) CHECK(begun == 3);
  }
}
