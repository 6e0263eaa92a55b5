#pragma once
/// for_all: independent tasks, side by side on the machine's processors.
#include <cstddef>
#include <functional>

namespace drev {

/// How many threads for_all() makes of `count` tasks: as many as asked for, 0: one for each of the machine's
/// processors; no more than tasks, one at least.
std::size_t thread_count(std::size_t count, int threads = 0);

/// Calls task(i, thread) for i = 0 to count - 1, each once, in this thread (number 0) and in others beside
/// it, thread_count() in all. After the first exception no further task begins, and it is thrown when all
/// that began have ended.
void for_all(std::size_t count, int threads,
             const std::function<void(std::size_t i, std::size_t thread)>& task);

}  // namespace drev
