#pragma once
/// The loops of TrigonometricSum over kLanes sums at a time, for run_widest(). Internal to trigonometric_sum.cpp.
#include <cstring>
#include <limits>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

/// The vector type that fills one register where lanes have the type L.
template <class L>
struct RegisterOf {
  using Type = Lanes;
};
template <>
struct RegisterOf<LanePair> {
  using Type = LanePair::Half;
};
/// Loads the lanes of a row from number `first` on, as many as a register holds; and stores them.
template <class Part>
[[gnu::always_inline]] inline void take_part(const LaneRow& row, int first, Part& to) {
  std::memcpy(&to, reinterpret_cast<const double*>(&row.v) + first, sizeof to);
}
template <class Part>
[[gnu::always_inline]] inline void put_part(const Part& from, int first, LaneRow& row) {
  std::memcpy(reinterpret_cast<double*>(&row.v) + first, &from, sizeof from);
}

/// Values y at all points of the cycle, from the sums over a quarter of it:
///   cos n (pi - x) = (-1)^n cos n x, sin n (pi - x) = -(-1)^n sin n x, and both times (-1)^n at x + pi.
/// ends: receives the highest and the lowest value.
struct SumQuarters {
  template <class L>
  [[gnu::always_inline]] static void run(int points, int orders, int even, const double* cosines,
                                         const double* sines, const LaneRow* re, const LaneRow* im,
                                         LaneRow* y, LaneRow* ends) {
    const int quarter = points / 4;
    L most = L{} - std::numeric_limits<double>::infinity(), least = -1.0 * most;
    // Two points at a time, so that each amplitude is read once for both.
    for (int p = 0; p <= quarter; p += 2, cosines += 2 * orders, sines += 2 * orders) {
      L ce{}, se{}, co{}, so{}, ce_2{}, se_2{}, co_2{}, so_2{}, x;
      for (int k = 0; k < even; ++k) {
        take(re[k], x), ce += cosines[k] * x, ce_2 += cosines[orders + k] * x;
        take(im[k], x), se += sines[k] * x, se_2 += sines[orders + k] * x;
      }
      for (int k = even; k < orders; ++k) {
        take(re[k], x), co += cosines[k] * x, co_2 += cosines[orders + k] * x;
        take(im[k], x), so += sines[k] * x, so_2 += sines[orders + k] * x;
      }
      const auto write = [&](int at, const L& value) __attribute__((always_inline)) {
        raise(most, value), sink(least, value);
        put(value, y[at]);
      };
      const auto write_four = [&](int at, const L& cos_even, const L& sin_even, const L& cos_odd,
                                  const L& sin_odd) __attribute__((always_inline)) {
        write(at, cos_even + cos_odd - (sin_even + sin_odd));
        write(2 * quarter - at, cos_even - cos_odd + (sin_even - sin_odd));
        write(2 * quarter + at, cos_even - cos_odd - (sin_even - sin_odd));
        write(at > 0 ? points - at : 0, cos_even + cos_odd + (sin_even + sin_odd));
      };
      write_four(p, ce, se, co, so);
      if (p < quarter) write_four(p + 1, ce_2, se_2, co_2, so_2);
    }
    put(most, ends[0]), put(least, ends[1]);
  }
};

/// Number of points in a word of marks: the bits of a double's significand.
inline constexpr int kMarksAWord = 52;

/// Marks the points within half a step of which the largest value may be, and those for the smallest: bit
/// p % kMarksAWord of tops[p / kMarksAWord], and of bottoms, in each lane. slack: S = B h^3 / 15.5 by which
/// the sum may exceed the parabola through three points, with B a bound of the third derivative; ends:
/// highest and lowest value of the points; y: values, with the points before and after the cycle.
///
/// A maximum at x in [-1/2, 1/2] has slope 0 and no upward curvature. With the errors B h^3 / 6 of the
/// parabola's slope and B h^3 / 2 of its curvature, the middle point is at most 2/3 B h^3 = 10.4 S below its
/// neighbours. With c the downward curvature, the parabola rises above the middle point by at most c/8 where
/// its vertex is in this interval, otherwise by |slope|/2 - c/8.
struct MarkExtremes {
  template <class L>
  [[gnu::always_inline]] static void run(int points, const LaneRow* y, const LaneRow* slack,
                                         const LaneRow* ends, LaneRow* tops, LaneRow* bottoms) {
    using Part = typename RegisterOf<L>::Type;
    constexpr int kWidth = sizeof(Part) / sizeof(double);
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      Part least, most, room, before, here, after;
      take_part(*slack, lane, room), take_part(ends[0], lane, least), take_part(ends[1], lane, most);
      least -= room, most += room;
      const Part below_neighbours = 10.4 * room;
      take_part(y[-1], lane, before), take_part(y[0], lane, here);
      for (int first = 0; first < points; first += kMarksAWord) {
        const int end = points - first < kMarksAWord ? points : first + kMarksAWord;
        const Part none{};
        Part top{}, bottom{}, bit = none + 1.0;
        for (int p = first; p < end; ++p) {
          take_part(y[p + 1], lane, after);
          const Part rise = here - before, fall = here - after, eighth = 0.125 * (rise + fall),
                     quarter = 0.25 * (rise - fall), steep = quarter > none ? quarter : -quarter,
                     end_up = steep - eighth, end_down = steep + eighth,
                     reach = here + (eighth > end_up ? eighth : end_up),
                     depth = here - (-eighth > end_down ? -eighth : end_down);
          // The smallest of three differences that must not be negative, and the largest of three that must
          // not be positive; not a number: none. Written as choices between doubles, since GCC 12 splits
          // masks of lanes.
          Part over = rise < fall ? rise : fall, below = rise > fall ? rise : fall;
          over += below_neighbours;
          below -= below_neighbours;
          const Part over_least = reach - least, under = depth - most;
          over = over < over_least ? over : over_least;
          below = below > under ? below : under;
          top += over >= none ? bit : none;
          bottom += below <= none ? bit : none;
          bit += bit;
          before = here;
          here = after;
        }
        put_part(top, lane, tops[first / kMarksAWord]), put_part(bottom, lane, bottoms[first / kMarksAWord]);
      }
    }
  }
};

/// Tops at up to kLanes places, from the polynomial through the seven points around each, times its sign.
/// at: place of its maximum within half a step, by Newton's method from a start, both in steps from the
/// middle point; value: the polynomial there; reach: upper bound of the sum within half a step. Where the
/// polynomial is concave throughout, the bound is the highest value of its tangent plus the largest
/// contribution of the seventh derivative: |x (x^2 - 1) (x^2 - 4) (x^2 - 9)| / 7! < kSeventh.
struct LookBetween {
  static constexpr int kSides = 3;
  static constexpr double kSeventh = 12.35 / 5040.0;
  template <class L>
  [[gnu::always_inline]] static void run(const LaneRow* y, const LaneRow* rest, LaneRow* at, LaneRow* reach,
                                         LaneRow* value) {
    L middle, x, limit, right, left, d1, d2, d3, s1, s2, s3;
    take(y[kSides], middle), take(*at, x), take(*reach, limit);
    const auto sides = [&](int k, L& difference, L& sum) __attribute__((always_inline)) {
      take(y[kSides + k], right), take(y[kSides - k], left);
      difference = right - left;
      sum = right + left - 2.0 * middle;
    };
    sides(1, d1, s1), sides(2, d2, s2), sides(3, d3, s3);
    // Derivatives at the middle point divided by their factorials.
    const L c1 = 0.75 * d1 - 0.15 * d2 + d3 / 60.0, c2 = 0.75 * s1 - 0.075 * s2 + s3 / 180.0,
            c3 = (8.0 * d2 - 13.0 * d1 - d3) / 48.0, c4 = (12.0 * s2 - 39.0 * s1 - s3) / 144.0,
            c5 = (5.0 * d1 - 4.0 * d2 + d3) / 240.0, c6 = (15.0 * s1 - 6.0 * s2 + s3) / 720.0;
    const auto slope = [&](L & to) __attribute__((always_inline)) {
      to = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * (5.0 * c5 + x * 6.0 * c6))));
    };
    L tilt, start = x, away;
    for (int step = 0; step < 2; ++step) {
      slope(tilt);
      const L bend = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * (20.0 * c5 + x * 30.0 * c6)));
      x -= tilt / bend;
    }
    // If the place is unreliable or not a number, take the start.
    away = x - start;
    magnitude(away);
    const L half = L{} + 0.5;
    keep_where_not_below(half, away, start, x);
    sink(x, half), raise(x, -1.0 * half);
    L addition, upwards;
    slope(tilt);
    upwards = tilt * (half - x);
    raise(upwards, -1.0 * tilt * (half + x));
    take(*rest, addition);
    const L height = middle + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * (c5 + x * c6)))));
    L bound = height + upwards + addition;
    // Upper bound of the second derivative within half a step.
    L b3 = c3, b4 = c4, b5 = c5, b6 = c6;
    magnitude(b3), magnitude(b4), magnitude(b5), magnitude(b6);
    const L bends = 2.0 * c2 + 3.0 * b3 + 3.0 * b4 + 2.5 * b5 + 1.875 * b6;
    keep_where_not_below(L{}, bends, limit, bound);
    sink(limit, bound);
    put(x, *at), put(limit, *reach), put(height, *value);
  }
};

/// Powers exp(i n angle), n = 0, 1, ... count - 1 (count even), with angle = point + away, exp(i point) given
/// and |away| < 0.6 rad, by a series to rounding and products of every second power.
struct FindPowers {
  template <class L>
  [[gnu::always_inline]] static void run(int count, const LaneRow* point, const LaneRow* away, LaneRow* re,
                                         LaneRow* im) {
    L x, point_re, point_im;
    take(*away, x), take(point[0], point_re), take(point[1], point_im);
    const L d = x * x;
    const L c =
        1.0 - 0.5 * d *
                  (1.0 - d * (1.0 / 12.0) *
                             (1.0 - d * (1.0 / 30.0) *
                                        (1.0 - d * (1.0 / 56.0) *
                                                   (1.0 - d * (1.0 / 90.0) * (1.0 - d * (1.0 / 132.0))))));
    const L s =
        x *
        (1.0 - d * (1.0 / 6.0) *
                   (1.0 - d * (1.0 / 20.0) *
                              (1.0 - d * (1.0 / 42.0) *
                                         (1.0 - d * (1.0 / 72.0) *
                                                    (1.0 - d * (1.0 / 110.0) * (1.0 - d * (1.0 / 156.0)))))));
    L odd_re = point_re * c - point_im * s, odd_im = point_re * s + point_im * c;
    const L two_re = odd_re * odd_re - odd_im * odd_im, two_im = 2.0 * odd_re * odd_im;
    L even_re = L{} + 1.0, even_im{};
    for (int n = 0; n < count; n += 2) {
      put(even_re, re[n]), put(even_im, im[n]);
      put(odd_re, re[n + 1]), put(odd_im, im[n + 1]);
      const L next_even = even_re * two_re - even_im * two_im, next_odd = odd_re * two_re - odd_im * two_im;
      even_im = even_re * two_im + even_im * two_re;
      odd_im = odd_re * two_im + odd_im * two_re;
      even_re = next_even, odd_re = next_odd;
    }
  }
};

/// From an angle whose powers exp(i n angle) are given by place: the value and five derivatives there, and
/// the step to the place where the slope of that Taylor polynomial is 0: Halley's step, unless it reverses
/// Newton's, followed by one Newton step.
struct FollowTop {
  struct Found {
    LaneRow value, bend, step, behind;  ///< behind: value of the sum after the step
  };
  template <class L>
  [[gnu::always_inline]] static void run(int orders, const int* multiples, const int* places,
                                         const LaneRow* re, const LaneRow* im, const LaneRow* power_re,
                                         const LaneRow* power_im, Found* found) {
    // One register-wide vector at a time, so that all sums stay in registers.
    using Part = typename RegisterOf<L>::Type;
    constexpr int kWidth = sizeof(Part) / sizeof(double);
    for (int first = 0; first < kLanes; first += kWidth) {
      Part y{}, s1{}, s2{}, s3{}, s4{}, s5{}, x_re, x_im, p_re, p_im;
      for (int k = 0; k < orders; ++k) {
        const double n = multiples[k], n_2 = n * n;
        take_part(re[k], first, x_re), take_part(im[k], first, x_im);
        take_part(power_re[places[k]], first, p_re), take_part(power_im[places[k]], first, p_im);
        Part a = x_re * p_re - x_im * p_im, b = n * (x_re * p_im + x_im * p_re);
        y += a;
        s1 -= b;
        a *= n_2, b *= n_2;
        s2 -= a;
        s3 += b;
        s4 += n_2 * a;
        s5 -= n_2 * b;
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
      put_part(y, first, found->value), put_part(s2, first, found->bend);
      put_part(d, first, found->step), put_part(behind, first, found->behind);
    }
  }
};

/// sums: upper bounds of the sums of weight |a| and of other |a|, from |a| <= larger + half of the smaller
/// part. Not finite where an amplitude is not.
struct BoundSizes {
  template <class L>
  [[gnu::always_inline]] static void run(int orders, const double* weights, const double* others,
                                         const LaneRow* re, const LaneRow* im, LaneRow* sums) {
    L sum{}, other{}, a, b, apart;
    for (int k = 0; k < orders; ++k) {
      take(re[k], a), take(im[k], b);
      magnitude(a), magnitude(b);
      apart = a - b;
      magnitude(apart);
      a = 0.75 * (a + b) + 0.25 * apart;
      sum += weights[k] * a, other += others[k] * a;
    }
    put(sum, sums[0]), put(other, sums[1]);
  }
};

}  // namespace drev
