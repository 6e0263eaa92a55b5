#include "solvers/periodic/load_harmonics.hpp"

#include <drev/core/law/law_force.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <array>
#include <cmath>

#include "core/dense/fourier.hpp"

namespace drev {

namespace {

constexpr int kMoments = 12;
constexpr int kMostStretches = 1000;  // largest number of stretches in a cell
constexpr int kBisections = 50;
/// Points of the 8-point Gauss rule on [-1, 1].
constexpr std::array<double, 8> kPoints{-kGaussPoints[3], -kGaussPoints[2], -kGaussPoints[1],
                                        -kGaussPoints[0], kGaussPoints[0],  kGaussPoints[1],
                                        kGaussPoints[2],  kGaussPoints[3]};
constexpr std::array<double, 8> kWeights{kGaussWeights[3], kGaussWeights[2], kGaussWeights[1],
                                         kGaussWeights[0], kGaussWeights[0], kGaussWeights[1],
                                         kGaussWeights[2], kGaussWeights[3]};

/// Spherical Bessel function j_m(x) by its power series; 0 <= x < 1.
double spherical_bessel(int m, double x) {
  double factor = 1.0, sum = 1.0, term = 1.0;
  for (int k = 1; k <= m; ++k) factor *= x / (2 * k + 1);
  for (int k = 1; k <= 10; ++k) sum += term *= -0.5 * x * x / (k * (2 * m + 2 * k + 1));
  return factor * sum;
}

using Moments = Eigen::Matrix<double, kMoments, 1>;

/// Legendre polynomials P_0, P_1, ... at xi.
Moments legendre(double xi) {
  Moments p;
  p[0] = 1.0;
  p[1] = xi;
  for (int m = 2; m < kMoments; ++m) p[m] = ((2 * m - 1) * xi * p[m - 1] - (m - 1) * p[m - 2]) / m;
  return p;
}

/// Legendre polynomials at the Gauss points of an undivided cell; almost all cells are undivided.
const std::array<Moments, kPoints.size()>& whole_cell() {
  static const auto all = [] {
    std::array<Moments, kPoints.size()> p;
    for (std::size_t g = 0; g < p.size(); ++g) p[g] = legendre(kPoints[g]);
    return p;
  }();
  return all;
}

/// An angle over a cell: the cubic through its values and rates (per half cell) at xi = -1 and 1.
struct CellAngle {
  double a, b, c, d;
  CellAngle(double y_0, double r_0, double y_1, double r_1)
      : a(0.5 * (y_0 + y_1) + 0.25 * (r_0 - r_1)),
        b(0.75 * (y_1 - y_0) - 0.25 * (r_0 + r_1)),
        c(0.25 * (r_1 - r_0)),
        d(0.25 * (y_0 - y_1) + 0.25 * (r_0 + r_1)) {}
  double at(double xi) const { return a + xi * (b + xi * (c + xi * d)); }
};

}  // namespace

LoadHarmonics::LoadHarmonics(const System& system) : system_(system) {
  for (std::size_t l = 0; l < system.loads().size(); ++l) {
    const LoadTerm& term = system.loads()[l];
    rows_.push_back(system.row_of(term.node));
    if (system.node_map(term.node).prescribed >= 0) continue;
    const bool taken = term.load->breakpoints().empty() && term.load->stretch(0.0, 0.0, 1.0);
    (taken ? taken_ : others_).push_back(static_cast<int>(l));
  }
}

void LoadHarmonics::moments(int load, double w, const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                            Eigen::MatrixXd& mu) const {
  const LoadTerm& term = system_.loads()[idx(load)];
  const auto cells = static_cast<int>(q.cols());
  const double dt = kTwoPi / (w * cells), ratio = system_.ratio(term.node);
  const bool follows = term.load->depends_on_motion();
  const auto angle = [&](int s) {
    const MotionPoint phi = system_.reference() ? system_.reference()->at(s * dt) : MotionPoint{};
    const int k = s % cells;
    MotionPoint theta{ratio * phi.value, ratio * phi.rate, 0.0};
    if (follows)
      for (const Entry& e : rows_[idx(load)]) {
        theta.value += e.coeff * q(e.index, k);
        theta.rate += e.coeff * v(e.index, k);
      }
    return theta;
  };
  mu.setZero(kMoments, cells);
  MotionPoint left = angle(0);
  double direction = left.rate >= 0.0 ? 1.0 : -1.0, t_0 = 0.0, theta_0 = left.value;
  LoadStretch stretch = term.load->stretch(t_0, theta_0, direction).value_or(LoadStretch{});
  for (int s = 0; s < cells; ++s) {
    const MotionPoint right = angle(s + 1);
    const CellAngle theta(left.value, 0.5 * dt * left.rate, right.value, 0.5 * dt * right.rate);
    double from = -1.0;
    for (int count = 1; from < 1.0; ++count) {
      // The end of the stretch in the direction in which the angle changes.
      double to = 1.0, edge = right.value;
      if (right.value > stretch.high) edge = stretch.high, direction = 1.0;
      if (right.value < stretch.low) edge = stretch.low, direction = -1.0;
      const bool ends = edge != right.value && count < kMostStretches;
      if (ends) {
        double low = from;
        for (int i = 0; i < kBisections; ++i) {
          const double middle = 0.5 * (low + to);
          (direction * (theta.at(middle) - edge) < 0.0 ? low : to) = middle;
        }
      }
      const double half = 0.5 * (to - from);
      for (std::size_t g = 0; g < kPoints.size(); ++g) {
        const double xi = from + half * (1.0 + kPoints[g]);
        const double f = stretch.torque + stretch.time_slope * ((s + 0.5 * (1.0 + xi)) * dt - t_0) +
                         stretch.angle_slope * (theta.at(xi) - theta_0);
        mu.col(s) += half * kWeights[g] * f * (half == 1.0 ? whole_cell()[g] : legendre(xi));
      }
      from = to;
      if (!ends) continue;
      t_0 = (s + 0.5 * (1.0 + to)) * dt;
      theta_0 = edge;
      stretch = term.load->stretch(t_0, theta_0, direction).value_or(LoadStretch{});
    }
    left = right;
  }
}

void LoadHarmonics::add(double w, const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                        Eigen::MatrixXcd& out) const {
  if (taken_.empty()) return;
  const auto samples = static_cast<int>(q.cols());
  Eigen::MatrixXcd weights(out.cols(), kMoments);
  for (Eigen::Index n = 0; n < out.cols(); ++n) {
    const double x = kPi * static_cast<double>(n) / samples;
    std::complex<double> power = std::polar(1.0 / samples, -x);
    for (int m = 0; m < kMoments; ++m, power *= std::complex<double>(0.0, -1.0))
      weights(n, m) = power * ((n == 0 ? 0.5 : 1.0) * (2 * m + 1) * spherical_bessel(m, x));
  }
  FourierTransform transform;
  Eigen::MatrixXd mu;
  std::vector<std::complex<double>> lines;
  for (const int l : taken_) {
    moments(l, w, q, v, mu);
    for (int m = 0; m < kMoments; ++m) {
      const std::vector<double> of_m(mu.row(m).begin(), mu.row(m).end());
      transform.forward(lines, of_m);
      for (Eigen::Index n = 0; n < out.cols(); ++n)
        for (const Entry& e : rows_[idx(l)])
          out(e.index, n) += e.coeff * weights(n, m) * lines[static_cast<std::size_t>(n)];
    }
  }
}

}  // namespace drev
