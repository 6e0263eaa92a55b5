#pragma once
/// Lanes: eight doubles at once, in loops that a processor's widest vectors should run.
///
/// A function marked DREV_WIDEST is compiled for several x86-64 levels; the program takes the best one
/// that the machine has when it starts. Elsewhere, and under sanitizers, it is compiled once.
#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace drev {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define DREV_WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define DREV_WIDEST
#endif

inline constexpr int kLanes = 8;
// Aligned in any function alike: else each level would take its own vectors' alignment for granted.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(kLanes * sizeof(double))));
/// What a comparison of lanes gives: all bits of a lane set, or none.
using LaneMask =
    std::int64_t __attribute__((vector_size(kLanes * sizeof(double)), aligned(kLanes * sizeof(double))));

/// One number of each lane's.
struct LaneRow {
  Lanes v{};
};
using LaneArray = std::vector<LaneRow>;
/// Doubles that begin on a vector's boundary: a load of a whole vector across two lines of the cache takes twice the time, and one of
/// what was just stored there several times that.
using LaneVector = std::vector<double, Eigen::aligned_allocator<double>>;
static_assert(EIGEN_MAX_ALIGN_BYTES == kLanes * sizeof(double));

/// Numbers that are often the same in all lanes: then kept singly too, for loops that read them often and
/// want to stay in the nearest cache.
struct LaneValues {
  LaneArray rows;
  std::vector<double> common;  ///< empty where lanes differ
  /// Fills common from rows.
  void find_common() {
    common.clear();
    for (const LaneRow& row : rows)
      for (int lane = 1; lane < kLanes; ++lane)
        if (!(row.v[lane] == row.v[0])) return;
    for (const LaneRow& row : rows) common.push_back(row.v[0]);
  }
};

/// Of either kind of LaneValues' entries, in loops written for both.
[[gnu::always_inline]] inline const double& each(const double& x) { return x; }
[[gnu::always_inline]] inline const Lanes& each(const LaneRow& x) { return x.v; }
[[gnu::always_inline]] inline double& each(double& x) { return x; }
[[gnu::always_inline]] inline Lanes& each(LaneRow& x) { return x.v; }

/// Smallest multiple of kLanes that is not less than n.
constexpr int whole_lanes(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

// By reference: a vector passed by value has another calling convention on each level.
[[gnu::always_inline]] inline void load(const double* from, Lanes& to) { std::memcpy(&to, from, sizeof to); }
[[gnu::always_inline]] inline void store(const Lanes& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}
[[gnu::always_inline]] inline void magnitude(Lanes& x) {
  x = reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(x) & std::numeric_limits<std::int64_t>::max());
}
[[gnu::always_inline]] inline void magnitude(double& x) { x = __builtin_fabs(x); }
/// most = max(most, |x|).
[[gnu::always_inline]] inline void larger(Lanes& most, const Lanes& x) {
  Lanes size = x;
  magnitude(size);
  most = most < size ? size : most;
}
[[gnu::always_inline]] inline bool any(const LaneMask& mask) {
  static_assert(kLanes == 8);
  LaneMask m = mask | __builtin_shufflevector(mask, mask, 4, 5, 6, 7, 0, 1, 2, 3);
  m |= __builtin_shufflevector(m, m, 2, 3, 0, 1, 2, 3, 0, 1);
  return (m[0] | m[1]) != 0;
}
// For code that is compiled for one double and for lanes.
[[gnu::always_inline]] inline bool any(bool mask) { return mask; }
/// to = value in these lanes.
template <class Number, class Mask>
[[gnu::always_inline]] inline void put_where(const Mask& lanes, const Number& value, Number& to) {
  to = lanes ? value : to;
}

}  // namespace drev
