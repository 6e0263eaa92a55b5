#pragma once
/// LegendreProjection: forces that are no polynomials of time, as polynomials over a step.
///
/// A force f(s), s in [0, 1], is replaced by sum a_j L_j(s), a_j = (2j+1) int f L_j ds, with the shifted
/// Legendre polynomials L_j. The rest is orthogonal to every polynomial of degree kProjectionDegree, and the
/// end of a step is int G(1-s) f(s) ds with a smooth G: its error is the product of the rest with what G has
/// above that degree, so that kinks inside a step cost next to nothing at its end (Galerkin orthogonality;
/// e.g. K. Eriksson, D. Estep, P. Hansbo, C. Johnson, Computational Differential Equations, 1996, chapter
/// 9). Inside the step the motion is off by about h^2 |rest|/(m D^3).
#include <drev/core/lanes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace drev {

inline constexpr int kProjectionDegree = 8;
inline constexpr int kProjectionTerms = kProjectionDegree + 1;

template <int kTerms>
using PowersOf = std::array<std::array<double, kTerms>, kTerms>;
/// L_j = sum_k t[j][k] s^k, t[j][k] = (-1)^(j+k) binomial(j, k) binomial(j+k, k).
template <int kTerms>
PowersOf<kTerms> legendre_powers() {
  PowersOf<kTerms> t{};
  for (int j = 0; j < kTerms; ++j) {
    double value = j % 2 ? -1.0 : 1.0;
    for (int k = 0; k <= j; ++k) {
      t[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] = value;
      value *= -static_cast<double>((j - k) * (j + k + 1)) / ((k + 1.0) * (k + 1.0));
    }
  }
  return t;
}

/// Gauss-Legendre nodes and weights on [0, 1], with L_j at the nodes.
struct GaussRule {
  static constexpr int kNodes = 12;
  /// Where the step's end is looked at: a force that jumps there, at a breakpoint, is asked for ahead of the jump.
  static constexpr double kAheadOfEnd = 1.0 - 1e-9;
  std::array<double, kNodes> s, weight;
  std::array<std::array<double, kNodes>, kProjectionTerms> legendre;
  std::array<double, kNodes> at_start,
      at_end;  ///< weights of the projection's values at s = 0 and kAheadOfEnd

  /// How far the projection of a force is from its values at the ends of the step: more than its last coefficients, where the
  /// force changes between an end and the node beside it, which no node sees.
  double off_at_ends(const std::array<double, kNodes>& at_nodes, double start, double end) const {
    for (std::size_t q = 0; q < at_nodes.size(); ++q) {
      start -= at_start[q] * at_nodes[q];
      end -= at_end[q] * at_nodes[q];
    }
    return std::max(std::abs(start), std::abs(end));
  }
};
const GaussRule& gauss_rule();
/// A polynomial of s and its slope at the nodes of Gauss's rule over [0, end].
struct NodeValues {
  std::array<double, whole_lanes(GaussRule::kNodes)> value, slope;
};
void find_at_nodes(std::span<const double> polynomial, double end, NodeValues& out);
/// Nodes and weights of Gauss's rule of n nodes on [0, 1].
void find_gauss_rule(int n, double* s, double* weight);

/// The polynomial of degree kNodes - 1 through values at the nodes of the Gauss rule, by powers of s.
struct NodePolynomial {
  std::array<double, GaussRule::kNodes> power{};
  double tail = 0.0;  ///< size of its last two Legendre coefficients: what a smooth function's rest is below
};
/// rounding: of the values; what bends by no more is left out, since powers of s would carry it far.
NodePolynomial through_nodes(const std::array<double, GaussRule::kNodes>& values, double rounding);

/// One force's projection from its values at the nodes, to be asked between them.
class NodeFit {
 public:
  explicit NodeFit(const std::array<double, GaussRule::kNodes>& values) {
    const GaussRule& rule = gauss_rule();
    for (std::size_t j = 0; j < a_.size(); ++j) {
      for (std::size_t q = 0; q < values.size(); ++q)
        a_[j] += rule.weight[q] * rule.legendre[j][q] * values[q];
      a_[j] *= 2.0 * static_cast<double>(j) + 1.0;
    }
  }
  double at(double s) const {
    const double x = 2.0 * s - 1.0;
    double sum = 0.0, now = 1.0, before = 0.0;
    for (std::size_t j = 0; j < a_.size(); ++j) {
      sum += a_[j] * now;
      const double k = static_cast<double>(j), next = ((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0);
      before = now;
      now = next;
    }
    return sum;
  }

 private:
  std::array<double, kProjectionTerms> a_{};
};

/// Forces by node of Gauss's rule and row.
class NodeForces {
 public:
  explicit NodeForces(int stride)
      : stride_(stride), f_(GaussRule::kNodes * static_cast<std::size_t>(stride)) {}
  void clear() { std::fill(f_.begin(), f_.end(), 0.0); }
  double& at(std::size_t q, int row) {
    return f_[q * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(row)];
  }
  const double* data() const { return f_.data(); }

 private:
  int stride_;
  LaneVector f_;
};

/// Coefficients a_j of one force a row, and their conversion to powers of s.
class LegendreProjection {
 public:
  /// stride: rows, in whole lanes.
  explicit LegendreProjection(int stride) : stride_(stride), a_(kProjectionTerms * size()) {}

  void clear() { std::fill(a_.begin(), a_.end(), 0.0); }
  LegendreProjection& operator+=(const LegendreProjection& other) {
    for (std::size_t i = 0; i < a_.size(); ++i) a_[i] += other.a_[i];
    return *this;
  }
  double& coefficient(int j, int row) { return a_[static_cast<std::size_t>(j * stride_ + row)]; }
  double coefficient(int j, int row) const { return a_[static_cast<std::size_t>(j * stride_ + row)]; }
  /// out: of each row, the sum of |differences| of the coefficients.
  void difference(const LegendreProjection& other, double* out) const;
  /// Adds the coefficients of forces that are known at the nodes of Gauss's rule.
  void add_nodes(const NodeForces& forces);
  /// out_k += coefficients of s^k for k < kept, out_k = them above, k = 0 ... kProjectionDegree; column k at
  /// out + k stride.
  void add_powers(int kept, double* out) const;

 private:
  std::size_t size() const { return static_cast<std::size_t>(stride_); }
  int stride_;
  LaneVector a_;
};

}  // namespace drev
