#pragma once
/// LanePair and run_widest(): loops over eight doubles at once, compiled for several levels of x86-64, each with
/// the type of lanes that its registers hold.
///
/// A vector of 64 bytes (core/lanes.hpp) lies in one register with AVX-512. On a level without it, compilers pass
/// it through memory at each operation, at a tenth of the speed; there a pair of vectors of 32 bytes is taken.
#include <drev/core/lanes.hpp>

#include <algorithm>
#include <array>

namespace drev {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define DREV_SERIES_LEVELS
#endif

/// Eight doubles in two vectors. Loops written over a type of lanes take this one or Lanes.
struct LanePair {
  using Half = double __attribute__((vector_size(kLanes * sizeof(double) / 2), aligned(8)));
  Half low, high;

  double operator[](int lane) const { return lane < kLanes / 2 ? low[lane] : high[lane - kLanes / 2]; }
#define DREV_BY_HALVES(op)                                                                   \
  [[gnu::always_inline]] friend LanePair operator op(const LanePair& a, const LanePair& b) { \
    return {a.low op b.low, a.high op b.high};                                               \
  }                                                                                          \
  [[gnu::always_inline]] friend LanePair operator op(double a, const LanePair& b) {          \
    return {a op b.low, a op b.high};                                                        \
  }                                                                                          \
  [[gnu::always_inline]] friend LanePair operator op(const LanePair& a, double b) {          \
    return {a.low op b, a.high op b};                                                        \
  }                                                                                          \
  [[gnu::always_inline]] LanePair& operator op##=(const LanePair& b) { return *this = *this op b; }
  DREV_BY_HALVES(+)
  DREV_BY_HALVES(-)
  DREV_BY_HALVES(*)
  DREV_BY_HALVES(/)
#undef DREV_BY_HALVES
};
[[gnu::always_inline]] inline void load(const double* from, LanePair& to) {
  std::memcpy(&to.low, from, sizeof to.low);
  std::memcpy(&to.high, from + kLanes / 2, sizeof to.high);
}
[[gnu::always_inline]] inline void store(const LanePair& from, double* to) {
  std::memcpy(to, &from.low, sizeof from.low);
  std::memcpy(to + kLanes / 2, &from.high, sizeof from.high);
}
/// to = from[index[lane]] by lanes.
[[gnu::always_inline]] inline void gather(const double* from, const int* index, Lanes& to) {
  to = Lanes{from[index[0]], from[index[1]], from[index[2]], from[index[3]],
             from[index[4]], from[index[5]], from[index[6]], from[index[7]]};
}
[[gnu::always_inline]] inline void gather(const double* from, const int* index, LanePair& to) {
  to.low = LanePair::Half{from[index[0]], from[index[1]], from[index[2]], from[index[3]]};
  to.high = LanePair::Half{from[index[4]], from[index[5]], from[index[6]], from[index[7]]};
}
[[gnu::always_inline]] inline void magnitude(LanePair& x) {
  using Bits = std::int64_t __attribute__((vector_size(kLanes * sizeof(double) / 2), aligned(8)));
  constexpr std::int64_t kAllButSign = std::numeric_limits<std::int64_t>::max();
  x.low = reinterpret_cast<LanePair::Half>(reinterpret_cast<Bits>(x.low) & kAllButSign);
  x.high = reinterpret_cast<LanePair::Half>(reinterpret_cast<Bits>(x.high) & kAllButSign);
}
/// most = max(most, x).
[[gnu::always_inline]] inline void raise(Lanes& most, const Lanes& x) { most = most < x ? x : most; }
[[gnu::always_inline]] inline void raise(LanePair& most, const LanePair& x) {
  most.low = most.low < x.low ? x.low : most.low;
  most.high = most.high < x.high ? x.high : most.high;
}
/// to = x < 0 ? a : b by lanes.
[[gnu::always_inline]] inline void choose(const Lanes& x, const Lanes& a, const Lanes& b, Lanes& to) {
  to = x < 0.0 ? a : b;
}
[[gnu::always_inline]] inline void choose(const LanePair& x, const LanePair& a, const LanePair& b,
                                          LanePair& to) {
  to.low = x.low < 0.0 ? a.low : b.low;
  to.high = x.high < 0.0 ? a.high : b.high;
}
/// least = min(least, x).
[[gnu::always_inline]] inline void sink(Lanes& least, const Lanes& x) { least = x < least ? x : least; }
[[gnu::always_inline]] inline void sink(LanePair& least, const LanePair& x) {
  least.low = x.low < least.low ? x.low : least.low;
  least.high = x.high < least.high ? x.high : least.high;
}
/// to = otherwise in the lanes where a >= b does not hold, not a number included. A choice between doubles: GCC 12
/// takes masks of lanes to pieces.
[[gnu::always_inline]] inline void keep_where_not_below(const Lanes& a, const Lanes& b,
                                                        const Lanes& otherwise, Lanes& to) {
  to = a >= b ? to : otherwise;
}
[[gnu::always_inline]] inline void keep_where_not_below(const LanePair& a, const LanePair& b,
                                                        const LanePair& otherwise, LanePair& to) {
  to.low = a.low >= b.low ? to.low : otherwise.low;
  to.high = a.high >= b.high ? to.high : otherwise.high;
}
/// A row of lanes, or one number for all of them, as lanes of either type; and back. By reference: a vector passed by
/// value has another calling convention on each level.
[[gnu::always_inline]] inline void take(const LaneRow& from, Lanes& to) { to = from.v; }
[[gnu::always_inline]] inline void take(const LaneRow& from, LanePair& to) {
  load(reinterpret_cast<const double*>(&from.v), to);
}
// Written out: the sum of a number and zeros is an addition, since it changes the sign of -0.
[[gnu::always_inline]] inline void take(double from, Lanes& to) {
  to = Lanes{from, from, from, from, from, from, from, from};
}
[[gnu::always_inline]] inline void take(double from, LanePair& to) {
  const LanePair::Half each{from, from, from, from};
  to = {each, each};
}
[[gnu::always_inline]] inline void put(const Lanes& from, LaneRow& to) { to.v = from; }
[[gnu::always_inline]] inline void put(const LanePair& from, LaneRow& to) {
  store(from, reinterpret_cast<double*>(&to.v));
}
/// Transposes as many registers as a register has lanes: lane j of x[i] to lane i of x[j].
[[gnu::always_inline]] inline void transpose(LanePair::Half (&x)[kLanes / 2]) {
  const LanePair::Half a = __builtin_shufflevector(x[0], x[1], 0, 4, 2, 6),
                       b = __builtin_shufflevector(x[0], x[1], 1, 5, 3, 7),
                       c = __builtin_shufflevector(x[2], x[3], 0, 4, 2, 6),
                       d = __builtin_shufflevector(x[2], x[3], 1, 5, 3, 7);
  x[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), x[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  x[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), x[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
template <int kDistance>
[[gnu::always_inline]] inline void exchange_blocks(Lanes& a, Lanes& b) {
  const Lanes x = a, y = b;
  if constexpr (kDistance == 1) {
    a = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    b = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  } else if constexpr (kDistance == 2) {
    a = __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13);
    b = __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
  } else {
    a = __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11);
    b = __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15);
  }
}
[[gnu::always_inline]] inline void transpose(Lanes (&x)[kLanes]) {
  for (int i = 0; i < kLanes; i += 2) exchange_blocks<1>(x[i], x[i + 1]);
  for (int i = 0; i < kLanes; i += 4)
    exchange_blocks<2>(x[i], x[i + 2]), exchange_blocks<2>(x[i + 1], x[i + 3]);
  for (int i = 0; i < kLanes / 2; ++i) exchange_blocks<4>(x[i], x[i + 4]);
}
/// Numbers in pairs, as those of std::complex are, as two rows of lanes: the first of each pair and the second; and back.
[[gnu::always_inline]] inline void take_pairs(const double* from, Lanes& first, Lanes& second) {
  Lanes low, high;
  load(from, low), load(from + kLanes, high);
  first = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14);
  second = __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15);
}
[[gnu::always_inline]] inline void take_pairs(const double* from, LanePair& first, LanePair& second) {
  LanePair low, high;
  load(from, low), load(from + kLanes, high);
  first.low = __builtin_shufflevector(low.low, low.high, 0, 2, 4, 6);
  first.high = __builtin_shufflevector(high.low, high.high, 0, 2, 4, 6);
  second.low = __builtin_shufflevector(low.low, low.high, 1, 3, 5, 7);
  second.high = __builtin_shufflevector(high.low, high.high, 1, 3, 5, 7);
}
[[gnu::always_inline]] inline void put_pairs(const Lanes& first, const Lanes& second, double* to) {
  const Lanes low = __builtin_shufflevector(first, second, 0, 8, 1, 9, 2, 10, 3, 11),
              high = __builtin_shufflevector(first, second, 4, 12, 5, 13, 6, 14, 7, 15);
  store(low, to), store(high, to + kLanes);
}
[[gnu::always_inline]] inline void put_pairs(const LanePair& first, const LanePair& second, double* to) {
  const LanePair low{__builtin_shufflevector(first.low, second.low, 0, 4, 1, 5),
                     __builtin_shufflevector(first.low, second.low, 2, 6, 3, 7)},
      high{__builtin_shufflevector(first.high, second.high, 0, 4, 1, 5),
           __builtin_shufflevector(first.high, second.high, 2, 6, 3, 7)};
  store(low, to), store(high, to + kLanes);
}
/// to = x with its halves, quarters or neighbours exchanged: lane l of x in lane l ^ distance.
[[gnu::always_inline]] inline void exchange(const Lanes& x, int distance, Lanes& to) {
  to = distance == 4   ? __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3)
       : distance == 2 ? __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5)
                       : __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
}
[[gnu::always_inline]] inline void exchange(const LanePair& x, int distance, LanePair& to) {
  const LanePair from = x;
  to.low = distance == 4   ? from.high
           : distance == 2 ? __builtin_shufflevector(from.low, from.low, 2, 3, 0, 1)
                           : __builtin_shufflevector(from.low, from.low, 1, 0, 3, 2);
  to.high = distance == 4   ? from.low
            : distance == 2 ? __builtin_shufflevector(from.high, from.high, 2, 3, 0, 1)
                            : __builtin_shufflevector(from.high, from.high, 1, 0, 3, 2);
}
/// All of x zero. One by one: an array that is zeroed at once takes a slow string instruction.
template <class L, int kCount>
[[gnu::always_inline]] inline void clear(L (&x)[kCount]) {
  for (int i = 0; i < kCount; ++i) x[i] = L{};
}
/// The sum of all lanes, and their largest.
template <class L>
[[gnu::always_inline]] inline double sum_of(const L& x) {
  L sum = x, other;
  exchange(sum, 4, other), sum += other;
  exchange(sum, 2, other), sum += other;
  exchange(sum, 1, other), sum += other;
  return sum[0];
}
[[gnu::always_inline]] inline double largest_of(const Lanes& x) {
  Lanes most = x, other;
  exchange(most, 4, other), raise(most, other);
  exchange(most, 2, other), raise(most, other);
  exchange(most, 1, other), raise(most, other);
  return most[0];
}
[[gnu::always_inline]] inline double largest_of(const LanePair& x) {
  LanePair::Half most = x.low < x.high ? x.high : x.low, other;
  other = __builtin_shufflevector(most, most, 2, 3, 0, 1);
  most = most < other ? other : most;
  other = __builtin_shufflevector(most, most, 1, 0, 3, 2);
  most = most < other ? other : most;
  return most[0];
}
/// Ones in the first lanes, so many, and zeros behind them.
inline constexpr auto kFirstLanes = [] {
  std::array<double, 2 * kLanes> ones{};
  for (std::size_t i = 0; i < kLanes; ++i) ones[i] = 1.0;
  return ones;
}();
inline const double* first_lanes(int count) { return kFirstLanes.data() + kLanes - std::min(count, kLanes); }
/// One bit a lane, set where x >= 0: no processor can foretell which of them are.
template <class L>
[[gnu::always_inline]] inline unsigned not_below_zero(const L& x) {
  static_assert(kLanes == 8);
  constexpr double kBits[kLanes] = {1, 2, 4, 8, 16, 32, 64, 128};
  L bits;
  load(kBits, bits);
  keep_where_not_below(x, L{}, L{}, bits);
  return static_cast<unsigned>(static_cast<int>(sum_of(bits)));
}
/// to = x moved up by a lane, behind the last lane of `before`; or down by a lane, ahead of the first one of `behind`.
[[gnu::always_inline]] inline void move_up(const Lanes& before, const Lanes& x, Lanes& to) {
  to = __builtin_shufflevector(before, x, 7, 8, 9, 10, 11, 12, 13, 14);
}
[[gnu::always_inline]] inline void move_down(const Lanes& x, const Lanes& behind, Lanes& to) {
  to = __builtin_shufflevector(x, behind, 1, 2, 3, 4, 5, 6, 7, 8);
}
[[gnu::always_inline]] inline void move_up(const LanePair& before, const LanePair& x, LanePair& to) {
  to.low = __builtin_shufflevector(before.high, x.low, 3, 4, 5, 6);
  to.high = __builtin_shufflevector(x.low, x.high, 3, 4, 5, 6);
}
[[gnu::always_inline]] inline void move_down(const LanePair& x, const LanePair& behind, LanePair& to) {
  to.low = __builtin_shufflevector(x.low, x.high, 1, 2, 3, 4);
  to.high = __builtin_shufflevector(x.high, behind.low, 1, 2, 3, 4);
}

#ifdef DREV_SERIES_LEVELS
/// to = lane index[lane] of `low` and, from kLanes on, of `high`. For loops on whole Lanes alone.
[[gnu::always_inline]] inline void pick(const Lanes& low, const Lanes& high, const LaneMask& index,
                                        Lanes& to) {
  to = __builtin_shuffle(low, high, index);
}
#endif
/// Whether loops run on whole Lanes, one in a register.
inline bool lanes_fill_a_register() {
#ifdef DREV_SERIES_LEVELS
  return __builtin_cpu_supports("x86-64-v4");
#else
  return false;
#endif
}

/// Kernel::run<L>(arguments...) with the type of lanes L that suits the best level of this machine. run is a
/// static member template, [[gnu::always_inline]], so that it is compiled once a level.
#ifdef DREV_SERIES_LEVELS
template <class Kernel, class... A>
[[gnu::noinline, gnu::target("arch=x86-64-v4")]] auto run_on_v4(A... arguments) {
  return Kernel::template run<Lanes>(arguments...);
}
template <class Kernel, class... A>
[[gnu::noinline, gnu::target("arch=x86-64-v3")]] auto run_on_v3(A... arguments) {
  return Kernel::template run<LanePair>(arguments...);
}
#endif
template <class Kernel, class... A>
[[gnu::noinline]] auto run_on_any(A... arguments) {
  return Kernel::template run<LanePair>(arguments...);
}
template <class Kernel, class... A>
auto run_widest(A... arguments) {
#ifdef DREV_SERIES_LEVELS
  static const auto best = __builtin_cpu_supports("x86-64-v4")   ? run_on_v4<Kernel, A...>
                           : __builtin_cpu_supports("x86-64-v3") ? run_on_v3<Kernel, A...>
                                                                 : run_on_any<Kernel, A...>;
  return best(arguments...);
#else
  return run_on_any<Kernel, A...>(arguments...);
#endif
}

}  // namespace drev
