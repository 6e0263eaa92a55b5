#pragma once
/// Processor time of this process so far [s], of all its threads; resolution some microseconds.
#include <ctime>

namespace drev {

inline double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace drev
