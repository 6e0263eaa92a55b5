#include "tests/benchmark/peers/step_floor.hpp"

#include <algorithm>
#include <ctime>

namespace peers {

namespace {

constexpr int kLanes = 8, kMeshes = 2;

/// Rows past the chain's end: inertia 1, no spring, no load.
class StepFloor {
 public:
  StepFloor(const Chain& c, double h, double load_tolerance)
      : c_(c), h_(h), q_(h * h / 4), tolerance_(load_tolerance) {
    for (int i = 0; i < kRows; ++i) {
      const double inertia = i < c.n ? c.inertia[i] : 1.0;
      low_[i] = c.low[i] * inertia, main_[i] = c.main[i] * inertia, up_[i] = c.up[i] * inertia;
      damping_[i] = c.damping[i] * inertia, load_[i] = c.load[i] * inertia;
      d_[i] = inertia + h / 2 * damping_[i] + q_ * main_[i];
    }
    for (int i = 1; i < kRows; ++i) {
      l_[i] = q_ * low_[i] / d_[i - 1];
      d_[i] -= l_[i] * q_ * low_[i];
    }
    for (double& d : d_) d = 1.0 / d;
    for (int j = 0; j < meshes(); ++j) {
      const Mesh& m = mesh(j);
      double b[kRows] = {};
      b[m.a] = m.arm_a;
      if (m.b >= 0) b[m.b] = m.arm_b;
      solve(b, w_[j]);
    }
    for (int i = 0; i < meshes(); ++i)
      for (int j = 0; j < meshes(); ++j) g_[i][j] = q_ * deflection(mesh(i), w_[j]);
    scale_ = loads(0.0);
    for (int i = 0; i < c.n; ++i) a_[i] = p_[i] / c.inertia[i];
  }

  void step(double t) {
    alignas(64) double z_0[kRows], v_0[kRows], known[kRows], rhs[kRows];
    for (int i = 0; i < kRows; ++i) {
      z_0[i] = z_[i] + h_ * v_[i] + q_ * a_[i];
      v_0[i] = v_[i] + h_ / 2 * a_[i];
      z_[i] = z_0[i] + q_ * a_[i];
      known[i] = -main_[i] * z_0[i] - damping_[i] * v_0[i];
    }
    for (int i = 1; i < kRows; ++i) known[i] -= low_[i] * z_0[i - 1];
    for (int i = 0; i < kRows - 1; ++i) known[i] -= up_[i] * z_0[i + 1];
    scale_ = std::max(scale_, largest([&](int i) { return known[i]; }));
    loads(t);
    do {
      ++run.load_passes;
      for (int i = 0; i < kRows; ++i) rhs[i] = known[i] + p_[i];
      solve(rhs, a_);
      if (meshes() > 0) add_contact(z_0);
      for (int i = 0; i < kRows; ++i) z_[i] = z_0[i] + q_ * a_[i];
    } while (loads(t) > tolerance_ * scale_);
    for (int i = 0; i < kRows; ++i) v_[i] = v_0[i] + h_ / 2 * a_[i];
    ++run.steps;
  }

  FloorRun finish() {
    run.z.assign(z_, z_ + c_.n), run.v.assign(v_, v_ + c_.n);
    return run;
  }
  FloorRun run;

 private:
  int meshes() const { return static_cast<int>(c_.meshes.size()); }
  const Mesh& mesh(int j) const { return c_.meshes[static_cast<std::size_t>(j)]; }

  template <class Value>
  static double largest(const Value& value) {
    double m[kLanes] = {};
    for (int i = 0; i < kRows; i += kLanes)
      for (int k = 0; k < kLanes; ++k) {
        const double x = std::abs(value(i + k));
        m[k] = x > m[k] ? x : m[k];
      }
    return *std::max_element(m, m + kLanes);
  }

  /// p_ at z_; returns its largest change.
  double loads(double t) {
    const double base = turns(c_, t) * c_.knots, *value = c_.value.data(), *rise = c_.rise.data();
    alignas(64) double change[kRows];
#pragma GCC ivdep
    for (int i = 0; i < kRows; ++i) {
      const double x = at_knots(c_, base, z_[i], c_.phase[i]);
      const int k = static_cast<int>(x), entry = c_.table[i] + k;
      const double p = load_[i] * (value[entry] + rise[entry] * (x - k));
      change[i] = p - p_[i];
      p_[i] = p;
    }
    return largest([&](int i) { return change[i]; });
  }

  /// x = S^-1 b by S = L D L'.
  void solve(const double* b, double* x) const {
    double last = b[0];
    x[0] = last;
    for (int i = 1; i < kRows; ++i) x[i] = last = b[i] - l_[i] * last;
    for (int i = 0; i < kRows; ++i) x[i] *= d_[i];
    for (int i = kRows - 2; i >= 0; --i) x[i] = last = x[i] - l_[i + 1] * last;
  }

  /// Forces y = k (x - s b), x = x_free - G y, s the sides that x itself says; a -= W y. Newton from the
  /// last sides; should it cycle, all sides in turn (one fits: G > 0 and y rises).
  void add_contact(const double* z_0) {
    double free[kMeshes], y[kMeshes] = {};
    for (int j = 0; j < meshes(); ++j) free[j] = deflection(mesh(j), z_0) + q_ * deflection(mesh(j), a_);
    for (int tries = 0, fits = 0; !fits && tries < 19; ++tries) {
      ++run.contact_passes;
      if (tries >= 10) sides_[0] = (tries - 10) % 3 - 1, sides_[1] = (tries - 10) / 3 - 1;
      forces(free, y);
      fits = 1;
      for (int j = 0; j < meshes(); ++j) {
        if (sides_[j] * y[j] > 0.0) continue;
        double x = free[j];
        for (int k = 0; k < meshes(); ++k) x -= g_[j][k] * y[k];
        fits = fits && sides_[j] == side(mesh(j), x);
        sides_[j] = side(mesh(j), x);
      }
    }
    for (int j = 0; j < meshes(); ++j) {
      scale_ = std::max(scale_, std::abs(y[j]));
      for (int i = 0; i < kRows; ++i) a_[i] -= w_[j][i] * y[j];
    }
  }

  /// (1/k + G) y = x_free - s b over the meshes that touch, by Cramer's rule.
  void forces(const double* free, double* y) const {
    double r[kMeshes] = {}, m[kMeshes][kMeshes] = {{1, 0}, {0, 1}};
    for (int i = 0; i < meshes(); ++i) {
      if (sides_[i] == 0) continue;
      r[i] = mesh(i).k * (free[i] - sides_[i] * mesh(i).half_gap);
      for (int j = 0; j < meshes(); ++j)
        if (sides_[j] != 0) m[i][j] += mesh(i).k * g_[i][j];
    }
    const double over = 1.0 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    y[0] = over * (r[0] * m[1][1] - m[0][1] * r[1]);
    y[1] = over * (m[0][0] * r[1] - r[0] * m[1][0]);
  }

  const Chain& c_;
  double h_, q_, tolerance_, scale_ = 0.0;
  alignas(64) double low_[kRows], main_[kRows], up_[kRows], damping_[kRows], load_[kRows];
  alignas(64) double l_[kRows] = {}, d_[kRows], w_[kMeshes][kRows];
  alignas(64) double z_[kRows] = {}, v_[kRows] = {}, a_[kRows] = {}, p_[kRows] = {};
  double g_[kMeshes][kMeshes];
  int sides_[kMeshes] = {};
};

}  // namespace

FloorRun run_step_floor(const Chain& chain, double step, double t_end, double load_tolerance) {
  const std::clock_t start = std::clock();
  StepFloor floor(chain, step, load_tolerance);
  const double count = std::ceil(t_end / step - 1e-6);
  for (double i = 1.0; i <= count; i += 1.0) floor.step(i * (t_end / count));
  FloorRun run = floor.finish();
  run.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return run;
}

}  // namespace peers
