// Tableau and dense output: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
// Equations I, 2nd ed. 1993, table II.5.2 and section II.6 (program DOPRI5).
#include "tests/benchmark/peers/lean_rk5.hpp"

#include <algorithm>
#include <ctime>

namespace peers {

namespace {

constexpr int kState = 2 * kRows;

template <class T>
class LeanRk5 {
 public:
  LeanRk5(const Chain& chain, const LeanOptions& options) : c_(chain), o_(options) {
    for (std::size_t j = 0; j < c_.meshes.size(); ++j) sides_[j] = 0;
    // Ahead of the start: a load that starts on a knot is on the interval behind it.
    for (int i = 0; i < c_.n; ++i) interval_[i] = interval(T(1e-9), T(0), i);
  }

  PeerRun run() {
    const std::clock_t start = std::clock();
    Sampler sampler(o_.t_end, o_.samples);
    T t = 0, h = T(1e-6);
    T previous = T(1e-4);
    evaluate(t, y_, k_[0]);
    while (t < o_.t_end) {
      bool last = false;
      if (t + h * T(1.0000001) >= o_.t_end) h = o_.t_end - t, last = true;
      const T error = step(t, h);
      if (!(error <= T(1))) {
        h *= std::max(T(0.2), T(0.9) * std::pow(error, T(-0.2)));
        continue;
      }
      const T grown =
          h * std::clamp(T(0.9) * std::pow(std::max(error, T(1e-10)), T(-0.17)) * std::pow(previous, T(0.04)),
                         T(0.2), T(5));
      bool changed = false;
      if (o_.changes || o_.knots) {
        const T s = first_change();
        if (s < T(1)) {
          last = false;
          step(t, h = s * h);
          t += h;
          pass();
          changed = true;
        }
      }
      if (!changed) t = last ? T(o_.t_end) : t + h;
      std::copy(new_, new_ + kState, y_);
      if (changed)
        evaluate(t, y_, k_[0]);
      else
        std::copy(k_[6], k_[6] + kState, k_[0]);
      previous = std::max(error, T(1e-4));
      h = grown;
      ++run_.steps;
      if (o_.samples) sampler.see(static_cast<double>(t), static_cast<double>(y_[c_.end]), run_.samples);
      if (run_.steps % 4096 == 0 && seconds(start) > kPatience) break;
    }
    run_.t_end = static_cast<double>(t);
    run_.seconds = seconds(start);
    return run_;
  }

 private:
  static double seconds(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }

  void evaluate(T t, const T* y, T* dy) {
    ++run_.evaluations;
    const T *z = y, *v = y + kRows;
    std::copy(v, v + kRows, dy);
    T* dv = dy + kRows;
    add_shaft(c_, z, v, dv);
    if (o_.knots && !c_.smooth)
      add_loads_on(c_, t, z, interval_, dv);
    else
      add_loads(c_, t, z, dv);
    add_meshes(c_, z, o_.changes ? sides_ : nullptr, dv);
  }

  template <int Stage>
  void stage(T t, T h, const T (&a)[Stage]) {
    for (int i = 0; i < kState; ++i) {
      T sum = a[0] * k_[0][i];
      for (int j = 1; j < Stage; ++j) sum += a[j] * k_[j][i];
      new_[i] = y_[i] + h * sum;
    }
    evaluate(t, new_, k_[Stage]);
  }

  /// From y_ to new_; returns the error over the tolerance.
  T step(T t, T h) {
    t_ = t, h_ = h;
    stage<1>(t + h / 5, h, {T(1) / 5});
    stage<2>(t + 3 * h / 10, h, {T(3) / 40, T(9) / 40});
    stage<3>(t + 4 * h / 5, h, {T(44) / 45, T(-56) / 15, T(32) / 9});
    stage<4>(t + 8 * h / 9, h, {T(19372) / 6561, T(-25360) / 2187, T(64448) / 6561, T(-212) / 729});
    stage<5>(t + h, h, {T(9017) / 3168, T(-355) / 33, T(46732) / 5247, T(49) / 176, T(-5103) / 18656});
    stage<6>(t + h, h, {T(35) / 384, T(0), T(500) / 1113, T(125) / 192, T(-2187) / 6784, T(11) / 84});
    T sum = 0;
    const T rtol = T(o_.rtol);
    for (int part = 0; part < 2; ++part) {
      const T scale = part == 0 ? T(kAngleScale) : T(kSpeedScale);
      for (int i = part * kRows; i < part * kRows + kRows; ++i) {
        const T e = T(71) / 57600 * k_[0][i] - T(71) / 16695 * k_[2][i] + T(71) / 1920 * k_[3][i] -
                    T(17253) / 339200 * k_[4][i] + T(22) / 525 * k_[5][i] - k_[6][i] / 40;
        const T r = h * e / (scale + std::max(std::abs(y_[i]), std::abs(new_[i])));
        sum += r * r;
      }
    }
    return std::sqrt(sum / static_cast<T>(2 * c_.n)) / rtol;
  }

  /// z_i inside the last step, 0 <= s <= 1.
  T inside(int i, T s) const {
    const T rise = new_[i] - y_[i], bend = h_ * k_[0][i] - rise;
    const T last =
        h_ * (T(-12715105075) / T(11282082432) * k_[0][i] + T(87487479700) / T(32700410799) * k_[2][i] -
              T(10690763975) / T(1880347072) * k_[3][i] + T(701980252875) / T(199316789632) * k_[4][i] -
              T(1453857185) / T(822651844) * k_[5][i] + T(69997945) / T(29380423) * k_[6][i]);
    return y_[i] + s * (rise + (1 - s) * (bend + s * (rise - h_ * k_[6][i] - bend + (1 - s) * last)));
  }

  int interval(T t, T z, int i) const {
    if (c_.smooth) return 0;
    return static_cast<int>(at_knots(c_, turns(c_, t) * static_cast<T>(c_.knots), z, c_.phase[i]));
  }
  /// Knots from the lower end of the interval that load i is kept on.
  T past_knot(T t, T z, int i) const {
    const T count = static_cast<T>(c_.knots);
    const T x = at_knots(c_, turns(c_, t) * count, z, c_.phase[i]) - static_cast<T>(interval_[i]);
    return x > count / 2 ? x - count : x < -count / 2 ? x + count : x;
  }

  /// g falls below zero up to s = high: where, by bisection sped up with secants (Illinois). Behind a
  /// change g starts at rounding's distance from zero.
  template <class G>
  static T root(const G& g, T high) {
    T a = 0, b = high, ga = g(a), gb = g(b);
    if (!(ga > T(0))) ga = g(a = T(1e-3) * high);
    if (!(ga > T(0))) return a;
    for (int i = 0; i < 60 && b - a > T(1e-15) * high; ++i) {
      const T s = (a * gb - b * ga) / (gb - ga), gs = g(s);
      if (gs >= T(0)) {
        a = s, ga = gs, gb /= 2;
      } else {
        b = s, gb = gs, ga /= 2;
      }
      if (std::abs(gs) < T(1e-18)) break;
    }
    return b;
  }

  T first_change() {
    T first = 1;
    which_mesh_ = which_load_ = -1;
    if (o_.changes)
      for (std::size_t j = 0; j < c_.meshes.size(); ++j) {
        const Mesh& m = c_.meshes[j];
        const auto x = [&](T s) {
          return m.arm_a * inside(m.a, s) + (m.b < 0 ? T(0) : m.arm_b * inside(m.b, s));
        };
        for (const int bound : {0, 1}) {
          const auto g = [&](T s) { return stays(m, sides_[j], x(s), bound); };
          for (const T s : {first / 2, first}) {  // half-way too: a short visit
            if (!(g(s) < T(0))) continue;
            first = root(g, s);
            which_mesh_ = static_cast<int>(j), which_side_ = bound == 0 ? 1 : -1;
            break;
          }
        }
      }
    if (o_.knots && !c_.smooth)
      for (int i = 0; i < c_.n; ++i) {
        if (c_.load[i] == 0.0) continue;
        const auto low = [&](T s) { return past_knot(t_ + s * h_, inside(i, s), i); };
        const T at_end = low(first);
        if (at_end >= T(0) && at_end <= T(1)) continue;
        const bool up = at_end > T(1);
        first = root([&](T s) { return up ? T(1) - low(s) : low(s); }, first);
        which_load_ = i, which_turn_ = up ? 1 : -1, which_mesh_ = -1;
      }
    return which_mesh_ < 0 && which_load_ < 0 ? T(2) : first;
  }

  void pass() {
    ++run_.changes;
    if (which_mesh_ >= 0)
      sides_[which_mesh_] = sides_[which_mesh_] == 0 ? which_side_ : 0;
    else
      interval_[which_load_] = (interval_[which_load_] + which_turn_ + c_.knots) % c_.knots;
  }

  const Chain& c_;
  LeanOptions o_;
  PeerRun run_;
  alignas(64) T y_[kState] = {}, new_[kState] = {}, k_[7][kState] = {};
  int sides_[8] = {}, interval_[kRows] = {};
  int which_mesh_ = -1, which_side_ = 0, which_load_ = -1, which_turn_ = 0;
  T t_ = 0, h_ = 0;
};

}  // namespace

PeerRun run_lean_rk5(const Chain& chain, const LeanOptions& options) {
  return LeanRk5<double>(chain, options).run();
}
PeerRun run_long_rk5(const Chain& chain, const LeanOptions& options) {
  return LeanRk5<long double>(chain, options).run();
}

}  // namespace peers
