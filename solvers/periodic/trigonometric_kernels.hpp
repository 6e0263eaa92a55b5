#pragma once
/// The loops of TrigonometricSum over kLanes sums at a time, for run_widest(). Internal to trigonometric_sum.cpp.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

/// Sets of kLanes sums that are processed side by side: row i of set s is at i kSumSets + s.
inline constexpr int kSumSets = 2;

/// The vector type that fills one register where lanes have the type L.
template <class L>
struct RegisterOf {
  using Type = Lanes;
  static constexpr int kRegisters = 1;  // that lanes take
  using Bits =
      std::uint64_t __attribute__((vector_size(kLanes * sizeof(double)), aligned(kLanes * sizeof(double))));
};
template <>
struct RegisterOf<LanePair> {
  using Type = LanePair::Half;
  static constexpr int kRegisters = 2;
  using Bits = std::uint64_t __attribute__((vector_size(kLanes * sizeof(double) / 2), aligned(8)));
};
/// A word of 64 bits of each lane.
struct LaneWord {
  std::uint64_t of[kLanes] = {};
};
/// The numbers of rows of lanes, one row behind the other.
[[gnu::always_inline]] inline double* numbers(LaneRow* rows) { return reinterpret_cast<double*>(&rows->v); }
[[gnu::always_inline]] inline const double* numbers(const LaneRow* rows) {
  return reinterpret_cast<const double*>(&rows->v);
}
/// Loads the lanes of a row from number `first` on, as many as a register holds; and stores them.
template <class Part>
[[gnu::always_inline]] inline void take_part(const LaneRow& row, int first, Part& to) {
  std::memcpy(&to, numbers(&row) + first, sizeof to);
}
template <class Part>
[[gnu::always_inline]] inline void put_part(const Part& from, int first, LaneRow& row) {
  std::memcpy(numbers(&row) + first, &from, sizeof from);
}

/// Complex amplitudes of kLanes sums, one behind the other, as rows of lanes: number k of each to row places[k].
/// Processes four at a time, up to count / 4 * 4.
struct TakeColumns {
  template <class L>
  [[gnu::always_inline]] static void run(int count, const double* const* columns, const int* places,
                                         LaneRow* re, LaneRow* im) {
    using Part = typename RegisterOf<L>::Type;
    constexpr int kWidth = sizeof(Part) / sizeof(double), kAtOnce = kLanes / 2;
    for (int first = 0; first < kLanes; first += kWidth)
      for (int k = 0; k < count / kAtOnce * kAtOnce; k += kWidth / 2)
        move<Part>(std::make_integer_sequence<int, kWidth>(), columns + first, k, first, places, re, im);
  }

 private:
  /// Written out, so that GCC 12 keeps the array in registers.
  template <class Part, int... i>
  [[gnu::always_inline]] static void move(std::integer_sequence<int, i...>, const double* const* columns,
                                          int k, int first, const int* places, LaneRow* re, LaneRow* im) {
    Part x[sizeof...(i)];
    (std::memcpy(&x[i], columns[i] + 2 * k, sizeof(Part)), ...);
    transpose(x);
    (put_part(x[i], first, (i % 2 == 0 ? re : im)[places[k + i / 2] * kSumSets]), ...);
  }
};

/// Values y at all points of the cycle, from sums over an eighth of it for even n, over a quarter for odd n. Both
/// follow, with x in the first eighth, from
///
///   cos n (pi/2 - x) = (-1)^(n/2) cos n x, sin n (pi/2 - x) = -(-1)^(n/2) sin n x     (n even)
///   cos n (pi - x)   = (-1)^n cos n x,     sin n (pi - x)   = -(-1)^n sin n x         and (-1)^n at x + pi.
///
///   cos n (pi/2 - x) = s sin n x, sin n (pi/2 - x) = s cos n x, s = (-1)^((n-1)/2)       (n odd)
///
/// Amplitudes: `fours` of multiples of four first, then those of other even numbers up to `even`, then those of odd
/// numbers with s = 1 up to `ones`, then the others. cosines, sines: [point of an eighth, and one more][amplitude]. ends: receives the highest values of all sets, then the lowest.
struct SumEighths {
  template <class L>
  struct Sums {
    L cosine{}, sine{};
  };
  /// The sums over the amplitudes [from, to) at two points, for kTile sets from number `set` on: each cosine and each
  /// amplitude is read once for all of them.
  template <int kTile, class L>
  [[gnu::always_inline]] static void sum(int from, int to, int set, const double* cosines_1,
                                         const double* sines_1, const double* cosines_2,
                                         const double* sines_2, const LaneRow* re, const LaneRow* im,
                                         Sums<L> (&at_1)[kTile], Sums<L> (&at_2)[kTile]) {
    L c_1[kTile], s_1[kTile], c_2[kTile], s_2[kTile];
    clear(c_1), clear(s_1), clear(c_2), clear(s_2);
    for (int k = from; k < to; ++k) {
      L x, of_1, of_2;
      take(cosines_1[k], of_1), take(cosines_2[k], of_2);
      for (int i = 0; i < kTile; ++i)
        take(re[k * kSumSets + set + i], x), c_1[i] += of_1 * x, c_2[i] += of_2 * x;
      take(sines_1[k], of_1), take(sines_2[k], of_2);
      for (int i = 0; i < kTile; ++i)
        take(im[k * kSumSets + set + i], x), s_1[i] += of_1 * x, s_2[i] += of_2 * x;
    }
    for (int i = 0; i < kTile; ++i) at_1[i] = {c_1[i], s_1[i]}, at_2[i] = {c_2[i], s_2[i]};
  }
  /// The sums over the odd amplitudes [from, to) at x, and those at pi/2 - x for s = kSign, are added.
  template <int kSign, int kTile, class L>
  [[gnu::always_inline]] static void add_odd(int from, int to, int set, const double* cosines,
                                             const double* sines, const LaneRow* re, const LaneRow* im,
                                             Sums<L> (&here)[kTile], Sums<L> (&behind)[kTile]) {
    for (int k = from; k < to; ++k) {
      L a, b, cosine, sine;
      take(cosines[k], cosine), take(sines[k], sine);
      for (int i = 0; i < kTile; ++i) {
        take(re[k * kSumSets + set + i], a), take(im[k * kSumSets + set + i], b);
        here[i].cosine += cosine * a, here[i].sine += sine * b;
        if constexpr (kSign > 0)
          behind[i].cosine += sine * a, behind[i].sine += cosine * b;
        else
          behind[i].cosine -= sine * a, behind[i].sine -= cosine * b;
      }
    }
  }
  template <int kTile, class L>
  [[gnu::always_inline]] static void run_tile(int set, int points, int orders, int fours, int even, int ones,
                                              const double* cosines, const double* sines, const LaneRow* re,
                                              const LaneRow* im, LaneRow* y, LaneRow* ends) {
    const int eighth = points / 8, quarter = points / 4, half = points / 2;
    L most[kTile], least[kTile];
    for (int i = 0; i < kTile; ++i)
      most[i] = L{} - std::numeric_limits<double>::infinity(), least[i] = -1.0 * most[i];
    const auto sum_at = [&](int from, int to, int point_1, int point_2, Sums<L>(&at_1)[kTile],
                            Sums<L>(&at_2)[kTile]) __attribute__((always_inline)) {
      sum<kTile, L>(from, to, set, cosines + point_1 * orders, sines + point_1 * orders,
                    cosines + point_2 * orders, sines + point_2 * orders, re, im, at_1, at_2);
    };
    const auto write = [&](int i, int at, const L& value) __attribute__((always_inline)) {
      raise(most[i], value), sink(least[i], value);
      put(value, y[at * kSumSets + set + i]);
    };
    // The sums over even n at x and -x, and those over odd ones.
    const auto write_four = [&](int i, int at, const L& here, const L& mirrored, const Sums<L>& odd)
        __attribute__((always_inline)) {
      const L apart = odd.cosine - odd.sine, together = odd.cosine + odd.sine;
      write(i, at, here + apart);
      write(i, half - at, mirrored - together);
      write(i, half + at, here - apart);
      write(i, at > 0 ? points - at : 0, mirrored + together);
    };
    const auto write_eight = [&](int p, const Sums<L>(&four)[kTile], const Sums<L>(&two)[kTile])
        __attribute__((always_inline)) {
      Sums<L> odd[kTile], odd_behind[kTile];
      const double *of_cosine = cosines + p * orders, *of_sine = sines + p * orders;
      add_odd<1>(even, ones, set, of_cosine, of_sine, re, im, odd, odd_behind);
      add_odd<-1>(ones, orders, set, of_cosine, of_sine, re, im, odd, odd_behind);
      for (int i = 0; i < kTile; ++i) {
        const L c_sum = four[i].cosine + two[i].cosine, s_sum = four[i].sine + two[i].sine;
        const L c_rest = four[i].cosine - two[i].cosine, s_rest = four[i].sine - two[i].sine;
        write_four(i, p, c_sum - s_sum, c_sum + s_sum, odd[i]);
        write_four(i, quarter - p, c_rest + s_rest, c_rest - s_rest, odd_behind[i]);
      }
    };
    for (int p = 0; p <= eighth; p += 2) {
      Sums<L> four[kTile], two[kTile], four_next[kTile], two_next[kTile];
      sum_at(0, fours, p, p + 1, four, four_next);
      sum_at(fours, even, p, p + 1, two, two_next);
      write_eight(p, four, two);
      if (p < eighth) write_eight(p + 1, four_next, two_next);
    }
    for (int i = 0; i < kTile; ++i) put(most[i], ends[set + i]), put(least[i], ends[kSumSets + set + i]);
  }
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int points, int orders, int fours, int even, int ones,
                                         const double* cosines, const double* sines, const LaneRow* re,
                                         const LaneRow* im, LaneRow* y, LaneRow* ends) {
    // Pairs of vectors fill the registers with one set alone.
    if constexpr (RegisterOf<L>::kRegisters == 1)
      if (sets == 2) {
        run_tile<2, L>(0, points, orders, fours, even, ones, cosines, sines, re, im, y, ends);
        return;
      }
    for (int set = 0; set < sets; ++set)
      run_tile<1, L>(set, points, orders, fours, even, ones, cosines, sines, re, im, y, ends);
  }
};

/// Number of points in a word of marks.
inline constexpr int kMarksAWord = 64;

/// Marks the points within half a step h of which the largest value may be, and those for the smallest: bit
/// p % kMarksAWord of tops[p / kMarksAWord], and of bottoms, in each lane. bounds: B_2 h^2 / 8 and 2/3 B_3 h^3, with
/// bounds B_2 and B_3 of the second and third derivatives; ends: highest and lowest value of the points; y: values,
/// with the points before and after the cycle.
///
/// A maximum within half a step is above its middle point by at most B_2 h^2 / 8, since its slope is 0. Its curvature
/// is not upwards: with the errors B_3 h^3 / 6 of the slope and B_3 h^3 / 2 of the curvature of the parabola through
/// three points, the middle one is at most 2/3 B_3 h^3 below its neighbours.
struct MarkExtremes {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int points, const LaneRow* y, const LaneRow* bounds,
                                         const LaneRow* ends, LaneWord* tops, LaneWord* bottoms) {
    using Part = typename RegisterOf<L>::Type;
    using Bits = typename RegisterOf<L>::Bits;
    constexpr int kWidth = sizeof(Part) / sizeof(double);
    constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;
    // Shifts the words by a bit and sets the new one where all three are >= 0; it may be set where one is not a
    // number.
    const auto note = [&](const Part& a, const Part& b, const Part& c, Bits& word)
        __attribute__((always_inline)) {
      const Bits signs = reinterpret_cast<Bits>(a) | reinterpret_cast<Bits>(b) | reinterpret_cast<Bits>(c);
      word = (word >> 1U) | (~signs & kSign);
    };
    for (int set = 0; set < sets; ++set)
      for (int lane = 0; lane < kLanes; lane += kWidth) {
        const auto value = [&](int point, Part& to) __attribute__((always_inline)) {
          take_part(y[point * kSumSets + set], lane, to);
        };
        Part least, most, room, below, before, here, after;
        take_part(bounds[set], lane, room), take_part(bounds[kSumSets + set], lane, below);
        take_part(ends[set], lane, least), take_part(ends[kSumSets + set], lane, most);
        least -= room, most += room;
        value(-1, before), value(0, here);
        // From one point to the next the sum falls, or rises, by no more than `below` where these are >= 0.
        Part falls_little = here - before + below, rises_little = below - (here - before);
        for (int first = 0; first < points; first += kMarksAWord) {
          const int count = points - first < kMarksAWord ? points - first : kMarksAWord;
          Bits top{}, bottom{};
#pragma GCC unroll 4
          for (int p = first; p < first + count; ++p) {
            value(p + 1, after);
            const Part rise = after - here, falls_next = rise + below, rises_next = below - rise;
            note(falls_little, rises_next, here - least, top);
            note(rises_little, falls_next, most - here, bottom);
            here = after, falls_little = falls_next, rises_little = rises_next;
          }
          top >>= static_cast<std::uint64_t>(kMarksAWord - count);
          bottom >>= static_cast<std::uint64_t>(kMarksAWord - count);
          const int word = first / kMarksAWord * kSumSets + set;
          std::memcpy(&tops[word].of[lane], &top, sizeof top);
          std::memcpy(&bottoms[word].of[lane], &bottom, sizeof bottom);
        }
      }
  }
};

/// kLanes places of tops: the values at seven points around each, and what LookBetween finds, times the sign.
struct TopRows {
  static constexpr int kSides = 3;
  LaneRow y[2 * kSides + 1];
  LaneRow sign;  ///< 1 for a maximum, -1 for a minimum
  LaneRow
      rest;  ///< largest excess of the sum within half a step over the polynomial through the seven points
  LaneRow shift;  ///< place of the polynomial's maximum within half a step, in steps from the middle point
  LaneRow value;  ///< the polynomial there
  LaneRow reach;  ///< upper bound of the sum within half a step
};

/// Tops from the polynomial p through seven points: its maximum by Newton's method from that of the parabola through
/// three points, both within half a step (|x| <= 1/2). With lower and upper bounds of p'' there, the sum is at most
/// the rest above
///
///   the highest value of the tangent at the place found      where p'' <= 0 throughout,
///   the higher end plus max(0, -p'')/8                       in any case.
///
/// The largest contribution of the seventh derivative is |x (x^2 - 1) (x^2 - 4) (x^2 - 9)| / 7! < kSeventh of it.
struct LookBetween {
  static constexpr int kSides = TopRows::kSides;
  static constexpr double kSeventh = 12.35 / 5040.0;
  template <class L>
  [[gnu::always_inline]] static void run(int count, TopRows* all) {
    for (TopRows* rows = all; rows != all + count; ++rows) {
      L sign, middle, right, left, d1, d2, d3, s1, s2, s3;
      take(rows->sign, sign);
      take(rows->y[kSides], middle), middle *= sign;
      const auto sides = [&](int k, L& difference, L& sum) __attribute__((always_inline)) {
        take(rows->y[kSides + k], right), take(rows->y[kSides - k], left);
        difference = sign * (right - left);
        sum = sign * (right + left) - 2.0 * middle;
      };
      sides(1, d1, s1), sides(2, d2, s2), sides(3, d3, s3);
      // Derivatives at the middle point divided by their factorials.
      const L c1 = 0.75 * d1 - 0.15 * d2 + d3 * (1.0 / 60.0),
              c2 = 0.75 * s1 - 0.075 * s2 + s3 * (1.0 / 180.0),
              c3 = (8.0 * d2 - 13.0 * d1 - d3) * (1.0 / 48.0),
              c4 = (12.0 * s2 - 39.0 * s1 - s3) * (1.0 / 144.0),
              c5 = (5.0 * d1 - 4.0 * d2 + d3) * (1.0 / 240.0),
              c6 = (15.0 * s1 - 6.0 * s2 + s3) * (1.0 / 720.0);
      const L half = L{} + 0.5;
      const auto inside = [&](L & place) __attribute__((always_inline)) {
        sink(place, half), raise(place, -1.0 * half);
      };
      const auto slope = [&](const L& at, L& to) __attribute__((always_inline)) {
        to = c1 + at * (2.0 * c2 + at * (3.0 * c3 + at * (4.0 * c4 + at * (5.0 * c5 + at * 6.0 * c6))));
      };
      // The parabola's maximum; its end that is higher where it has none inside, or none at all.
      L start = -0.5 * d1 / s1, tilt, end;
      inside(start);
      choose(d1, -1.0 * half, half, end);
      choose(s1, start, end, start);
      L x = start;
      for (int step = 0; step < 2; ++step) {
        slope(x, tilt);
        const L bend = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * (20.0 * c5 + x * 30.0 * c6)));
        x -= tilt / bend;
      }
      // If the place is unreliable or not a number, take the start.
      L away = x - start;
      magnitude(away);
      keep_where_not_below(half, away, start, x);
      inside(x);
      slope(x, tilt);
      L rest;
      take(rows->rest, rest);
      const L height = middle + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * (c5 + x * c6)))));
      L upwards = tilt * (half - x);
      raise(upwards, -1.0 * tilt * (half + x));
      const L by_tangent = height + upwards;
      // p'' at the middle point, and by how much it may differ within half a step.
      L b3 = c3, b4 = c4, b5 = c5, b6 = c6;
      magnitude(b3), magnitude(b4), magnitude(b5), magnitude(b6);
      const L bend = 2.0 * c2, varies = 3.0 * b3 + 3.0 * b4 + 2.5 * b5 + 1.875 * b6;
      L odd = 0.5 * c1 + 0.125 * c3 + 0.03125 * c5, downwards = varies - bend;
      magnitude(odd), raise(downwards, L{});
      L reach = middle + 0.25 * c2 + 0.0625 * c4 + 0.015625 * c6 + odd + 0.125 * downwards;
      L lower = by_tangent;
      sink(lower, reach);
      choose(bend + varies, lower, reach, reach);
      put(x, rows->shift), put(height, rows->value), put(reach + rest, rows->reach);
    }
  }
};

/// kLanes tops that are followed to y' = 0, each in a lane, times its sign.
struct FollowedTops {
  /// States; lost: the steps do not lead to a maximum near the start.
  static constexpr double kDone = 0.0, kOpen = 1.0, kLost = 2.0;
  LaneRow point[2];     ///< exp(i angle) of the nearest point
  LaneRow angle, sign;  ///< of that point [rad]; 1 for a maximum, -1 for a minimum
  LaneRow start, away;  ///< distances from the point [rad]: first and present one
  LaneRow value;        ///< largest value found, times the sign
  LaneRow state;
};

/// exp(i (angle + away)), exp(i angle) given, |away| < 0.6 rad, by a series to rounding.
template <class Part>
[[gnu::always_inline]] inline void turn(const Part& point_re, const Part& point_im, const Part& away,
                                        Part& re, Part& im) {
  const Part d = away * away;
  const Part c =
      1.0 - 0.5 * d *
                (1.0 - d * (1.0 / 12.0) *
                           (1.0 - d * (1.0 / 30.0) *
                                      (1.0 - d * (1.0 / 56.0) *
                                                 (1.0 - d * (1.0 / 90.0) * (1.0 - d * (1.0 / 132.0))))));
  const Part s =
      away *
      (1.0 - d * (1.0 / 6.0) *
                 (1.0 - d * (1.0 / 20.0) *
                            (1.0 - d * (1.0 / 42.0) *
                                       (1.0 - d * (1.0 / 72.0) *
                                                  (1.0 - d * (1.0 / 110.0) * (1.0 - d * (1.0 / 156.0)))))));
  re = point_re * c - point_im * s;
  im = point_re * s + point_im * c;
}

/// A step of tops: the value and five derivatives where they are, and the step to the place where the slope of that
/// Taylor polynomial is 0: Halley's step, unless it reverses Newton's, followed by one Newton step. A top is done where
/// the step is shorter than `near`; it is lost where the sum does not curve downwards, or farther than `far` from the
/// start.
///
/// rows: row in re and im of each n = 1 ... count, count even; a row of them is at kSumSets times its number. power_re, power_im: exp(i n angle) of each n; null: they
/// are found here, from the products of every second one.
struct FollowTop {
  template <class L>
  [[gnu::always_inline]] static void run(int count, const int* rows, const int* multiples, const LaneRow* re,
                                         const LaneRow* im, const LaneRow* power_re, const LaneRow* power_im,
                                         double near, double far, FollowedTops* tops) {
    // One register-wide vector at a time, so that all sums stay in registers.
    using Part = typename RegisterOf<L>::Type;
    constexpr int kWidth = sizeof(Part) / sizeof(double);
    for (int first = 0; first < kLanes; first += kWidth) {
      Part y{}, s1{}, s2{}, s3{}, s4{}, s5{}, p_re, p_im, sign, start, away, value, before;
      const auto add = [&](const Part& n, int row, const Part& of_re, const Part& of_im)
          __attribute__((always_inline)) {
        Part x_re, x_im;
        take_part(re[row * kSumSets], first, x_re), take_part(im[row * kSumSets], first, x_im);
        const Part n_2 = n * n;
        Part a = x_re * of_re - x_im * of_im, b = n * (x_re * of_im + x_im * of_re);
        y += a;
        s1 -= b;
        a *= n_2, b *= n_2;
        s2 -= a;
        s3 += b;
        s4 += n_2 * a;
        s5 -= n_2 * b;
      };
      take_part(tops->away, first, away);
      if (power_re) {
        for (int k = 0; k < count; ++k) {
          take_part(power_re[k], first, p_re), take_part(power_im[k], first, p_im);
          add(Part{} + multiples[k], k, p_re, p_im);
        }
      } else {
        Part odd_re, odd_im;
        take_part(tops->point[0], first, p_re), take_part(tops->point[1], first, p_im);
        turn(p_re, p_im, away, odd_re, odd_im);
        const Part two_re = odd_re * odd_re - odd_im * odd_im, two_im = 2.0 * odd_re * odd_im;
        p_re = two_re, p_im = two_im;
        Part n_odd = Part{} + 1.0, n_even = Part{} + 2.0;
        for (int n = 1; n < count; n += 2, n_odd += 2.0, n_even += 2.0) {
          add(n_odd, rows[n], odd_re, odd_im);
          add(n_even, rows[n + 1], p_re, p_im);
          const Part next_odd = odd_re * two_re - odd_im * two_im, next = p_re * two_re - p_im * two_im;
          odd_im = odd_re * two_im + odd_im * two_re;
          p_im = p_re * two_im + p_im * two_re;
          odd_re = next_odd, p_re = next;
        }
      }
      const Part newton = -s1 / s2, third = 1.0 + 0.5 * newton * s3 / s2, half = Part{} + 0.5;
      Part d = newton / (third > half ? third : half);
      const Part tilt = s1 + d * (s2 + d * (0.5 * s3 + d * ((1.0 / 6.0) * s4 + d * (1.0 / 24.0) * s5))),
                 curve = s2 + d * (s3 + d * (0.5 * s4 + d * (1.0 / 6.0) * s5)), closer = d - tilt / curve;
      // If the higher derivatives do not improve the step, take Halley's alone.
      Part moved = (closer - d) * (closer - d);
      d = moved < 0.01 * d * d ? closer : d;
      const Part behind =
          y + d * (s1 + d * (0.5 * s2 +
                             d * ((1.0 / 6.0) * s3 + d * ((1.0 / 24.0) * s4 + d * (1.0 / 120.0) * s5))));
      take_part(tops->sign, first, sign), take_part(tops->start, first, start);
      take_part(tops->value, first, value);
      take_part(tops->state, first, before);
      const Part none{}, is_open = none + FollowedTops::kOpen, is_lost = none + FollowedTops::kLost;
      const Part there = away + d, size = d < none ? -d : d, from_start = there - start,
                 distance = from_start < none ? -from_start : from_start, bend = sign * s2;
      Part best = sign * y, state = size < near ? none : is_open;
      best = best > value ? best : value;
      state = distance <= far ? state : is_lost;
      state = bend < none ? state : is_lost;
      Part end = sign * behind;
      end = state == none ? end : best;
      best = end > best ? end : best;
      const Part to = state < is_lost ? there : away;
      const auto change = [&](const Part& now, const Part& old, LaneRow& row) __attribute__((always_inline)) {
        const Part kept = before == is_open ? now : old;
        put_part(kept, first, row);
      };
      change(to, away, tops->away), change(best, value, tops->value), change(state, before, tops->state);
    }
  }
};

/// bounds: upper bounds of sum n^2 |a|, sum n^3 |a| and sum n^7 |a|, each of all sets, from |a| <= larger + half of the
/// smaller part. powers: these powers of each n. Not finite where an amplitude is not.
struct BoundSizes {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int orders, const std::array<double, 3>* powers,
                                         const LaneRow* re, const LaneRow* im, LaneRow* bounds) {
    for (int set = 0; set < sets; ++set) {
      L second{}, third{}, seventh{}, a, b, apart;
      for (int k = 0; k < orders; ++k) {
        take(re[k * kSumSets + set], a), take(im[k * kSumSets + set], b);
        magnitude(a), magnitude(b);
        apart = a - b;
        magnitude(apart);
        a = 0.75 * (a + b) + 0.25 * apart;
        second += powers[k][0] * a, third += powers[k][1] * a, seventh += powers[k][2] * a;
      }
      put(second, bounds[set]), put(third, bounds[kSumSets + set]), put(seventh, bounds[2 * kSumSets + set]);
    }
  }
};

}  // namespace drev
