#include "tests/stability/coverage/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace coverage {

namespace {

using Complex = std::complex<Real>;
using ComplexMatrix = std::vector<std::vector<Complex>>;

constexpr Real kLast = 1e-20L;  // relative size at which an entry counts as zero

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Mean over the mesh phase (docs/model_file.md, gear_mesh).
Real mean_stiffness(const Mesh& m) {
  if (m.kind == Mesh::Stiffness::step)
    return m.stiffness + (static_cast<Real>(m.both) - m.stiffness) * (static_cast<Real>(m.ratio) - 1);
  if (m.kind != Mesh::Stiffness::table) return m.stiffness;
  const auto &s = m.stiffness_table.arguments, &k = m.stiffness_table.values;
  Real sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const bool last = i + 1 == s.size();
    const Real next = last ? static_cast<Real>(s[0]) + 1 : static_cast<Real>(s[i + 1]);
    sum += (next - s[i]) * (static_cast<Real>(k[i]) + k[last ? 0 : i + 1]) / 2;
  }
  return sum;
}

/// Closed: of a dead band the mean of both outer slopes, of any other spring the slope at rest.
Real closed_stiffness(const Polyline& p) {
  const auto slope = [&](std::size_t i) {
    return (static_cast<Real>(p.y[i + 1]) - p.y[i]) / (static_cast<Real>(p.x[i + 1]) - p.x[i]);
  };
  std::size_t rest = 0;
  while (rest + 2 < p.x.size() && p.x[rest + 1] <= 0.0) ++rest;
  if (slope(rest) > 0) return slope(rest);
  return (slope(0) + slope(p.x.size() - 2)) / 2;
}

/// Upper Hessenberg, then shifted QR steps by plane rotations, from the last row up.
std::vector<Complex> eigenvalues(ComplexMatrix a) {
  const int n = static_cast<int>(a.size());
  const auto rotate = [&](int i, int j, int first, int last_row, Complex x, Complex y) {
    const Real r = std::hypot(std::abs(x), std::abs(y));
    if (r == 0) return;
    const Complex c = x / r, s = y / r;
    for (int k = first; k < n; ++k) {
      const Complex p = a[at(i)][at(k)], q = a[at(j)][at(k)];
      a[at(i)][at(k)] = std::conj(c) * p + std::conj(s) * q;
      a[at(j)][at(k)] = c * q - s * p;
    }
    for (int k = 0; k <= last_row; ++k) {
      const Complex p = a[at(k)][at(i)], q = a[at(k)][at(j)];
      a[at(k)][at(i)] = c * p + s * q;
      a[at(k)][at(j)] = std::conj(c) * q - std::conj(s) * p;
    }
  };
  for (int k = 0; k + 2 < n; ++k)
    for (int i = n - 1; i > k + 1; --i) rotate(i - 1, i, 0, n - 1, a[at(i - 1)][at(k)], a[at(i)][at(k)]);
  std::vector<Complex> found;
  int end = n - 1, tries = 0;
  while (end >= 0) {
    int begin = end;
    while (begin > 0 &&
           std::abs(a[at(begin)][at(begin - 1)]) >
               kLast * (std::abs(a[at(begin)][at(begin)]) + std::abs(a[at(begin - 1)][at(begin - 1)])))
      --begin;
    if (begin == end) {
      found.push_back(a[at(end)][at(end)]);
      --end, tries = 0;
      continue;
    }
    if (++tries > 500) throw std::runtime_error("the reference finds no eigenvalue");
    if (begin > 0) a[at(begin)][at(begin - 1)] = 0;
    const Complex p = a[at(end - 1)][at(end - 1)], s = a[at(end)][at(end)];
    const Complex half = (p - s) / static_cast<Real>(2);
    const Complex root = std::sqrt(half * half + a[at(end - 1)][at(end)] * a[at(end)][at(end - 1)]);
    Complex shift = s + half + (std::abs(half + root) < std::abs(half - root) ? root : -root);
    if (tries % 20 == 0) shift += std::abs(a[at(end)][at(end - 1)]);  // off a cycle
    for (int i = begin; i <= end; ++i) a[at(i)][at(i)] -= shift;
    // R = Q* A by rotations of neighbouring rows, then R Q.
    std::vector<std::pair<Complex, Complex>> turned;
    for (int i = begin; i < end; ++i) {
      const Complex x = a[at(i)][at(i)], y = a[at(i + 1)][at(i)];
      const Real r = std::hypot(std::abs(x), std::abs(y));
      const Complex c = r > 0 ? x / r : 1, sine = r > 0 ? y / r : 0;
      turned.emplace_back(c, sine);
      for (int k = i; k <= end; ++k) {
        const Complex u = a[at(i)][at(k)], v = a[at(i + 1)][at(k)];
        a[at(i)][at(k)] = std::conj(c) * u + std::conj(sine) * v;
        a[at(i + 1)][at(k)] = c * v - sine * u;
      }
    }
    for (int i = begin; i < end; ++i) {
      const auto [c, sine] = turned[at(i - begin)];
      for (int k = begin; k <= std::min(i + 1, end); ++k) {
        const Complex u = a[at(k)][at(i)], v = a[at(k)][at(i + 1)];
        a[at(k)][at(i)] = c * u + sine * v;
        a[at(k)][at(i + 1)] = std::conj(c) * v - std::conj(sine) * u;
      }
    }
    for (int i = begin; i <= end; ++i) a[at(i)][at(i)] += shift;
  }
  return found;
}

}  // namespace

LinearModel::LinearModel(const Spec& spec) {
  const std::size_t n = spec.nodes.size();
  std::vector<bool> driven(n, false);
  for (const Gear& g : spec.gears) driven[at(g.b)] = true;
  unknown_.assign(n, -1), factor_.assign(n, 1);
  for (std::size_t i = 0; i < n; ++i)
    if (!driven[i] && !spec.nodes[i].prescribed) unknown_[i] = size(), mass.push_back(0);
  for (const Gear& g : spec.gears)
    unknown_[at(g.b)] = unknown_[at(g.a)], factor_[at(g.b)] = factor_[at(g.a)] * g.ratio;
  damping.assign(mass.size(), std::vector<Real>(mass.size()));
  stiffness = damping;
  for (std::size_t i = 0; i < n; ++i) {
    if (unknown_[i] >= 0) mass[at(unknown_[i])] += factor_[i] * factor_[i] * spec.nodes[i].inertia;
    add(static_cast<int>(i), 1, -1, 0, 0, spec.rayleigh_mass * static_cast<Real>(spec.nodes[i].inertia));
  }
  for (const Shaft& s : spec.shafts)
    add(s.a, -1, s.b, 1, s.stiffness, s.damping + spec.rayleigh_stiffness * static_cast<Real>(s.stiffness));
  for (const Shaft& s : spec.springs) add(s.a, 1, -1, 0, s.stiffness, s.damping);
  for (const Shaft& s : spec.dashpots) add(s.a, s.b >= 0 ? -1 : 1, s.b, 1, 0, s.damping);
  for (const Mesh& m : spec.meshes)
    add(m.a, m.radius_a, m.b, m.internal ? -m.radius_b : m.radius_b, mean_stiffness(m), m.damping);
  for (const Polyline& p : spec.polylines)
    add(p.a, p.b >= 0 ? -1 : 1, p.b, 1, closed_stiffness(p), p.damping);
}

/// k and c along the row r_a q_a + r_b q_b.
void LinearModel::add(int a, Real r_a, int b, Real r_b, Real k, Real c) {
  const int nodes[2] = {a, b};
  const Real rows[2] = {r_a, r_b};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      if (nodes[i] < 0 || nodes[j] < 0) continue;
      const int u = unknown_[at(nodes[i])], v = unknown_[at(nodes[j])];
      if (u < 0 || v < 0) continue;
      const Real product = rows[i] * rows[j] * factor_[at(nodes[i])] * factor_[at(nodes[j])];
      stiffness[at(u)][at(v)] += k * product;
      damping[at(u)][at(v)] += c * product;
    }
}

std::vector<Real> symmetric_eigenvalues(const LinearModel& m) {
  const int n = m.size();
  auto a = m.stiffness;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a[at(i)][at(j)] /= std::sqrt(m.mass[at(i)] * m.mass[at(j)]);
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        if (a[at(p)][at(q)] == 0) continue;
        const Real ratio = (a[at(q)][at(q)] - a[at(p)][at(p)]) / (2 * a[at(p)][at(q)]);
        const Real t = (ratio >= 0 ? 1 : -1) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1));
        const Real c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < n; ++k) {
          const Real x = a[at(k)][at(p)], y = a[at(k)][at(q)];
          a[at(k)][at(p)] = c * x - s * y, a[at(k)][at(q)] = s * x + c * y;
        }
        for (int k = 0; k < n; ++k) {
          const Real x = a[at(p)][at(k)], y = a[at(q)][at(k)];
          a[at(p)][at(k)] = c * x - s * y, a[at(q)][at(k)] = s * x + c * y;
        }
      }
  }
  std::vector<Real> values;
  for (int i = 0; i < n; ++i) values.push_back(a[at(i)][at(i)]);
  return values;
}

std::vector<std::complex<Real>> quadratic_eigenvalues(const LinearModel& m) {
  const int n = m.size();
  Real largest = 0;  // scales time, so that both halves of the matrix are of one size
  for (int i = 0; i < n; ++i) largest = std::max(largest, m.stiffness[at(i)][at(i)] / m.mass[at(i)]);
  const Real w = largest > 0 ? std::sqrt(largest) : 1;
  ComplexMatrix a(at(2 * n), std::vector<Complex>(at(2 * n)));
  for (int i = 0; i < n; ++i) {
    a[at(i)][at(n + i)] = 1;
    for (int j = 0; j < n; ++j) {
      const Real root = std::sqrt(m.mass[at(i)] * m.mass[at(j)]);
      a[at(n + i)][at(j)] = -m.stiffness[at(i)][at(j)] / root / (w * w);
      a[at(n + i)][at(n + j)] = -m.damping[at(i)][at(j)] / root / w;
    }
  }
  std::vector<Complex> values = eigenvalues(std::move(a));
  for (Complex& v : values) v *= w;
  return values;
}

}  // namespace coverage
