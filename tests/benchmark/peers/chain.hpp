#pragma once
/// Chain: the camshaft as a careful user of a general integrator would write it, without drev.
///
///   z' = v,   v' = -low z_{i-1} - main z_i - up z_{i+1} - damping v + load(omega t + z_i) - meshes
///
/// All rows divided by their inertias. Every station has a load (of amplitude zero where there is
/// none), so that one loop without branches serves all. A mesh is a spring with a gap between two
/// stations (or one and a wheel that turns steadily), undamped as the model's default is.
///
/// Sources that include this are compiled for the machine at hand; nothing of Eigen may be in them.
#include <cmath>
#include <vector>

namespace peers {

constexpr int kRows = 40;  // most stations; multiple of 8

struct Mesh {
  int a = 0, b = -1;                  // stations; b = -1: steady wheel
  double arm_a = 0.0, arm_b = 0.0;    // m
  double push_a = 0.0, push_b = 0.0;  // arm over inertia
  double k = 0.0, half_gap = 0.0;     // N/m, m
};

struct Chain {
  int n = 0, end = 0;          ///< stations; which one is the free end
  double omega = 0.0;          ///< nominal speed of all stations with loads [rad/s]
  double inertia[kRows] = {};  ///< kg m^2
  alignas(64) double low[kRows] = {}, main[kRows] = {}, up[kRows] = {}, damping[kRows] = {};
  alignas(64) double phase[kRows] = {}, load[kRows] = {};  ///< rad; 1/inertia or amplitude/inertia
  std::vector<Mesh> meshes;

  // Loads from tables of even spacing: torque and its rise to the next knot.
  int knots = 0;
  alignas(64) int table[kRows] = {};  ///< first knot of the station's table
  std::vector<double> value, rise;

  // Smooth loads: pulse(w), w = (theta + phase)/width wrapped to half a turn either side.
  bool smooth = false;
  alignas(64) double inverse_width[kRows] = {};  ///< 1/rad
};

/// Odd pulse over -1 < w < 1, largest about 1, five times differentiable: 5.8 w (1 - w^2)^6.
template <class T>
inline T pulse(T w) {
  const T inside = T(1) - w * w, q = inside > T(0) ? inside : T(0), q2 = q * q;
  return T(5.8) * w * (q2 * q2 * q2);
}
template <class T>
inline T pulse_slope(T w) {
  const T inside = T(1) - w * w, q = inside > T(0) ? inside : T(0), q2 = q * q;
  return T(5.8) * (q2 * q2 * q) * (q - T(12) * w * w);
}

constexpr double kTurn = 6.283185307179586476925;

/// Nominal angle [turns, 0..1).
template <class T>
inline T turns(const Chain& c, T t) {
  const T u = T(c.omega) / (T(2) * std::acos(T(-1))) * t;
  return u - std::floor(u);
}

/// Angle of a station over its table [knots, 0..knots).
template <class T>
inline T at_knots(const Chain& c, T base, T z, double phase) {
  const T count = static_cast<T>(c.knots);
  T x = base + (z + phase) * (count / (T(2) * std::acos(T(-1))));
  x = x >= count ? x - count : x;
  return x < T(0) ? x + count : x;
}

/// Angle of a station about its pulse's middle [rad, -pi..pi).
template <class T>
inline T about_pulse(T base, T z, double phase) {
  const T turn = T(2) * std::acos(T(-1));
  T x = base + z + phase;
  x = x >= T(0.5) * turn ? x - turn : x;
  return x < T(-0.5) * turn ? x + turn : x;
}

/// dv of everything linear.
template <class T>
inline void add_shaft(const Chain& c, const T* z, const T* v, T* dv) {
  const int n = c.n;
  dv[0] = -c.main[0] * z[0] - c.up[0] * z[1] - c.damping[0] * v[0];
  for (int i = 1; i < n - 1; ++i)
    dv[i] = -c.low[i] * z[i - 1] - c.main[i] * z[i] - c.up[i] * z[i + 1] - c.damping[i] * v[i];
  dv[n - 1] = -c.low[n - 1] * z[n - 2] - c.main[n - 1] * z[n - 1] - c.damping[n - 1] * v[n - 1];
}

template <class T>
inline void add_loads(const Chain& c, T t, const T* z, T* dv) {
  const int n = c.n;
  const T share = turns(c, t);
  if (c.smooth) {
    const T base = share * (T(2) * std::acos(T(-1)));
    for (int i = 0; i < n; ++i)
      dv[i] += c.load[i] * pulse(about_pulse(base, z[i], c.phase[i]) * c.inverse_width[i]);
    return;
  }
  const T base = share * static_cast<T>(c.knots);
  const double *value = c.value.data(), *rise = c.rise.data();
  for (int i = 0; i < n; ++i) {
    const T x = at_knots(c, base, z[i], c.phase[i]);
    const int k = static_cast<int>(x);
    dv[i] += c.load[i] * (value[c.table[i] + k] + rise[c.table[i] + k] * (x - static_cast<T>(k)));
  }
}

/// The same with every load kept on the straight line of a knot interval.
template <class T>
inline void add_loads_on(const Chain& c, T t, const T* z, const int* interval, T* dv) {
  const T base = turns(c, t) * static_cast<T>(c.knots), count = static_cast<T>(c.knots);
  for (int i = 0; i < c.n; ++i) {
    const int k = interval[i];
    T past = at_knots(c, base, z[i], c.phase[i]) - static_cast<T>(k);
    past = past > count / 2 ? past - count : past;
    past = past < -count / 2 ? past + count : past;
    dv[i] += c.load[i] * (c.value[static_cast<std::size_t>(c.table[i] + k)] +
                          c.rise[static_cast<std::size_t>(c.table[i] + k)] * past);
  }
}

template <class T>
inline T deflection(const Mesh& m, const T* z) {
  return m.arm_a * z[m.a] + (m.b < 0 ? T(0) : m.arm_b * z[m.b]);
}
/// Which flank touches: 1 in front, -1 behind, 0 none.
template <class T>
inline int side(const Mesh& m, T x) {
  return x > T(m.half_gap) ? 1 : x < T(-m.half_gap) ? -1 : 0;
}

/// sides: the flanks that touch, kept; null: as the deflections say.
template <class T>
inline void add_meshes(const Chain& c, const T* z, const int* sides, T* dv) {
  for (std::size_t j = 0; j < c.meshes.size(); ++j) {
    const Mesh& m = c.meshes[j];
    const T x = deflection(m, z);
    const int s = sides ? sides[j] : side(m, x);
    if (s == 0) continue;
    const T y = m.k * (x - s * T(m.half_gap));
    dv[m.a] -= m.push_a * y;
    if (m.b >= 0) dv[m.b] -= m.push_b * y;
  }
}

template <class T>
inline void accelerations(const Chain& c, T t, const T* z, const T* v, const int* sides, T* dv) {
  add_shaft(c, z, v, dv);
  add_loads(c, t, z, dv);
  add_meshes(c, z, sides, dv);
}

/// What must stay positive for mesh j to keep its side (0: one of two).
template <class T>
inline T stays(const Mesh& m, int s, T x, int bound) {
  if (s == 0) return bound == 0 ? m.half_gap - x : m.half_gap + x;
  return bound == (s > 0 ? 0 : 1) ? s * x - m.half_gap : T(1);
}

/// Slope of a station's load in its angle, over its inertia [1/s^2].
inline double load_slope(const Chain& c, double t, double z, int i) {
  if (c.load[i] == 0.0) return 0.0;
  if (c.smooth)
    return c.load[i] * c.inverse_width[i] *
           pulse_slope(about_pulse(turns(c, t) * kTurn, z, c.phase[i]) * c.inverse_width[i]);
  const int k = static_cast<int>(at_knots(c, turns(c, t) * c.knots, z, c.phase[i]));
  return c.load[i] * c.rise[static_cast<std::size_t>(c.table[i] + k)] * c.knots / kTurn;
}

/// The chain's end at the end of a step.
struct Sample {
  double t = 0.0, angle = 0.0;
};

struct PeerRun {
  double seconds = 0.0;  ///< processor time
  double t_end = 0.0;    ///< less than asked for: it was cut for time, or failed
  long steps = 0, evaluations = 0, changes = 0;
  std::vector<Sample> samples;
};

/// Keeps the first step end past each of evenly spaced times.
class Sampler {
 public:
  Sampler(double t_end, int count) : spacing_(count > 0 ? t_end / count : 2.0 * t_end) {}
  void see(double t, double angle, std::vector<Sample>& to) {
    if (t < next_ * spacing_) return;
    to.push_back({t, angle});
    next_ = std::floor(t / spacing_) + 1.0;
  }

 private:
  double spacing_, next_ = 1.0;
};

constexpr double kAngleScale = 1e-2, kSpeedScale = 1.0;  // absolute tolerances are rtol times these
constexpr double kPatience = 120.0;                      // s of processor time

}  // namespace peers
