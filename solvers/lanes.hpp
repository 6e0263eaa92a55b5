#pragma once
/// Lanes: eight doubles at once, in loops that a processor's widest vectors should run.
///
/// A function marked DREV_WIDEST is compiled for several x86-64 levels; the program takes the best one
/// that the machine has when it starts. Elsewhere, and under sanitizers, it is compiled once.
#include <cstring>

namespace drev {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define DREV_WIDEST \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define DREV_WIDEST
#endif

inline constexpr int kLanes = 8;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// Smallest multiple of kLanes that is not less than n.
constexpr int whole_lanes(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

// By reference: a vector passed by value has another calling convention on each level.
[[gnu::always_inline]] inline void load(const double* from, Lanes& to) {
  std::memcpy(&to, from, sizeof to);
}
[[gnu::always_inline]] inline void store(const Lanes& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}

}  // namespace drev
