#include "solvers/load_harmonics.hpp"

#include <array>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "core/units.hpp"

namespace drev {

namespace {

constexpr int kMoments = 9;
constexpr int kMostStretches = 1000;  // in a cell
constexpr int kBisections = 50;
/// Gauss's rule of 5 points on [-1, 1].
constexpr std::array<double, 5> kPoints{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                        0.9061798459386640};
constexpr std::array<double, 5> kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};

/// Spherical Bessel function by its power series; 0 <= x < 1.
double spherical_bessel(int m, double x) {
  double factor = 1.0, sum = 1.0, term = 1.0;
  for (int k = 1; k <= m; ++k) factor *= x / (2 * k + 1);
  for (int k = 1; k <= 10; ++k) sum += term *= -0.5 * x * x / (k * (2 * m + 2 * k + 1));
  return factor * sum;
}

/// An angle over a cell: the cubic through values and rates (per half cell) at xi = -1 and 1.
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
    if (system.node_map(term.node).unknown < 0) continue;
    const bool taken = term.load->breakpoints().empty() && term.load->stretch(0.0, 0.0, 1.0);
    (taken ? taken_ : others_).push_back(static_cast<int>(l));
  }
}

void LoadHarmonics::moments(const LoadTerm& term, double w, const Eigen::MatrixXd& q,
                            const Eigen::MatrixXd& v, Eigen::MatrixXd& mu) const {
  const NodeMap& map = system_.node_map(term.node);
  const auto cells = static_cast<int>(q.cols());
  const double dt = kTwoPi / (w * cells), ratio = system_.ratio(term.node);
  const bool follows = term.load->depends_on_motion();
  const auto angle = [&](int s) {
    const MotionPoint phi = system_.reference() ? system_.reference()->at(s * dt) : MotionPoint{};
    const int k = s % cells;
    MotionPoint theta{ratio * phi.value, ratio * phi.rate, 0.0};
    if (follows) {
      theta.value += map.coeff * q(map.unknown, k);
      theta.rate += map.coeff * v(map.unknown, k);
    }
    return theta;
  };
  mu.setZero(cells, kMoments);
  MotionPoint left = angle(0);
  for (int s = 0; s < cells; ++s) {
    const MotionPoint right = angle(s + 1);
    const CellAngle theta(left.value, 0.5 * dt * left.rate, right.value, 0.5 * dt * right.rate);
    double from = -1.0, knot = left.value;
    for (int count = 1; from < 1.0; ++count) {
      const double direction = right.value >= knot ? 1.0 : -1.0, t = (s + 0.5 * (1.0 + from)) * dt;
      const LoadStretch stretch = term.load->stretch(t, knot, direction).value_or(LoadStretch{});
      double to = 1.0;
      const double edge = direction > 0.0 ? stretch.high : stretch.low, at_start = knot;
      if (count < kMostStretches && direction * (right.value - edge) > 0.0) {
        double low = from;
        for (int i = 0; i < kBisections; ++i) {
          const double middle = 0.5 * (low + to);
          (direction * (theta.at(middle) - edge) < 0.0 ? low : to) = middle;
        }
        knot = edge;
      }
      for (std::size_t g = 0; g < kPoints.size(); ++g) {
        const double half = 0.5 * (to - from), xi = from + half * (1.0 + kPoints[g]);
        const double f = half * kWeights[g] *
                         (stretch.torque + stretch.time_slope * 0.5 * dt * (xi - from) +
                          stretch.angle_slope * (theta.at(xi) - at_start));
        double p_0 = 1.0, p_1 = xi;
        for (int m = 0; m < kMoments; ++m) {
          mu(s, m) += f * p_0;
          const double p_2 = ((2 * m + 3) * xi * p_1 - (m + 1) * p_0) / (m + 2);
          p_0 = p_1, p_1 = p_2;
        }
      }
      from = to;
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
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::MatrixXd mu;
  std::vector<std::complex<double>> lines;
  for (const int l : taken_) {
    const LoadTerm& term = system_.loads()[at(l)];
    const NodeMap& map = system_.node_map(term.node);
    moments(term, w, q, v, mu);
    for (int m = 0; m < kMoments; ++m) {
      const std::vector<double> column(mu.col(m).begin(), mu.col(m).end());
      fft.fwd(lines, column);
      for (Eigen::Index n = 0; n < out.cols(); ++n)
        out(map.unknown, n) += map.coeff * weights(n, m) * lines[static_cast<std::size_t>(n)];
    }
  }
}

}  // namespace drev
