#include "tests/benchmark/peers/floor.hpp"

#include <algorithm>
#include <ctime>

namespace peers {

namespace {

volatile double kept;  // what is computed is needed, as far as the compiler knows

/// Seconds of one of `count` repetitions; fastest of 5.
template <class Work>
double seconds(int count, const Work& work) {
  double best = 1e9;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    double sum = 0.0;
    for (int k = 0; k < count; ++k) sum += work(k);
    kept = sum;
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / count);
  }
  return best;
}

}  // namespace

double seconds_per_degree(const Chain& c) {
  constexpr int kDegrees = 20;
  alignas(64) static double z[kDegrees + 2][kRows + 16] = {};  // 8 zeros either side
  for (int i = 0; i < kRows; ++i) z[0][8 + i] = 0.01 * i, z[1][8 + i] = 0.02 * i;
  const double h = 2e-4;
  return seconds(100000,
                 [&](int) {
                   for (int k = 0; k < kDegrees; ++k) {
                     const double f = h * h / ((k + 1.0) * (k + 2.0)), g = h / (k + 2.0);
                     const double *a = z[k] + 8, *b = z[k + 1] + 8;
                     double* out = z[k + 2] + 8;
                     for (int i = 0; i < kRows; ++i)
                       out[i] = -f * (c.low[i] * a[i - 1] + c.main[i] * a[i] + c.up[i] * a[i + 1]) -
                                g * c.damping[i] * b[i];
                   }
                   return z[kDegrees + 1][9];
                 }) /
         kDegrees;
}

double seconds_per_load(const Chain& c) {
  double z[kRows] = {}, dv[kRows] = {};
  const auto loads = std::count_if(c.load, c.load + kRows, [](double a) { return a != 0.0; });
  return seconds(1000000,
                 [&](int k) {
                   add_loads(c, 1e-6 * k, z, dv);
                   return dv[2];
                 }) /
         static_cast<double>(loads);
}

double seconds_per_root() {
  constexpr int kDegree = 16;
  return seconds(1000000, [](int k) {
    double s = 0.5;
    for (int i = 0; i < 4; ++i) {
      double p = 1.0 / 3e3, slope = 0.0;
      for (int d = kDegree - 1; d >= 0; --d) {
        slope = slope * s + p;
        p = p * s + (d == 0 ? -0.3 - 1e-8 * k : 1.0 / (1.0 + d * d));
      }
      s -= p / slope;
    }
    return s;
  });
}

}  // namespace peers
