#include "models/camshaft/steady_shaft.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/dense/fourier.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;
constexpr int kHarmonics = SteadyShaft::kSamples / 2 - 1;
constexpr Complex kI{0.0, 1.0};

/// c_n of f(u) = sum c_n e^{i n u}, f straight between the knots u_j: -1/(2 pi n^2) sum (change of slope at
/// u_j) e^{-i n u_j}.
std::vector<Complex> fourier(const PeriodicTable& table) {
  const std::vector<double>&u = table.arguments(), &slope = table.slopes();
  std::vector<Complex> c(kHarmonics + 1);
  c[0] = table.mean();
  for (std::size_t j = 0; j < u.size(); ++j) {
    const double kink = slope[j] - slope[(j + u.size() - 1) % u.size()];
    const Complex turn = std::polar(1.0, -u[j]);
    Complex e = turn;
    for (int n = 1; n <= kHarmonics; ++n, e *= turn)
      c[static_cast<std::size_t>(n)] -= kink * e / (kTwoPi * n * n);
  }
  return c;
}

int place_of(const std::vector<int>& order, int cylinder) {
  return static_cast<int>(std::find(order.begin(), order.end(), cylinder) - order.begin());
}

}  // namespace

SteadyShaft::SteadyShaft(int cylinders) : cylinders_(cylinders) {
  const ModelCase model_case = build_case(
      "camshaft", {{"cylinders", std::to_string(cylinders)}, {"drive", "held"}, {"damping", "undamped"}});
  const System system = model_case.model.build();
  const ModeSet modes = solve_modes(system, {.count = system.size()});
  const Eigen::Index count = modes.count();
  lambda_.resize(count);
  for (int m = 0; m < modes.count(); ++m) lambda_[m] = modes.omega(m) * modes.omega(m);

  std::vector<std::string> names{model_case.deflection};
  names.insert(names.end(), model_case.torques.begin(), model_case.torques.end());
  outputs_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(names.size()), count);
  Eigen::Index row = 0;
  for (const Channel& channel : find_channels(system, names)) {
    for (const drev::Entry& e : channel.z_row()) outputs_.row(row) += e.coeff * modes.vectors.row(e.index);
    ++row;
  }

  const CamTorques& torques = cam_torques();
  const std::vector<Complex> fuel = fourier(torques.fuel), exhaust = fourier(torques.exhaust),
                             inlet = fourier(torques.inlet);
  const std::vector<int> order = default_firing_order(cylinders);
  all_ = Spectrum::Zero(count, kHarmonics + 1);
  for (int k = 1; k <= cylinders; ++k) {
    const std::string n = "_" + std::to_string(k);
    const auto shape = [&](const std::string& name) { return modes.shapes.row(system.node(name + n)); };
    Spectrum force(count, kHarmonics + 1);
    for (int h = 0; h <= kHarmonics; ++h) {
      const auto at = static_cast<std::size_t>(h);
      force.col(h) = (fuel[at] * shape("fuel") + exhaust[at] * shape("exhaust") + inlet[at] * shape("inlet"))
                         .transpose();
      all_.col(h) += force.col(h) * std::polar(1.0, -kTwoPi * h * place_of(order, k) / cylinders);
    }
    force_.push_back(std::move(force));
  }
}

SteadyShaft::Waves SteadyShaft::respond(const Spectrum& force, double omega, const RayleighCase& damping,
                                        Eigen::Index count) const {
  const Eigen::MatrixXcd outputs = outputs_.topRows(count).cast<Complex>();
  Spectrum x(count, kHarmonics + 1);
  for (int h = 0; h <= kHarmonics; ++h) {
    const double w = h * omega;
    const Eigen::ArrayXcd dynamic = (lambda_.array() - w * w).cast<Complex>() +
                                    kI * w * (damping.a + damping.b * lambda_.array()).cast<Complex>();
    x.col(h) = outputs * (force.col(h).array() / dynamic).matrix();
  }
  Waves waves(kSamples, count);
  FourierTransform transform;
  std::vector<Complex> lines(kSamples / 2 + 1);  // the last one, at half the rate of the samples, is zero
  std::vector<double> samples;
  for (Eigen::Index c = 0; c < x.rows(); ++c) {
    for (int h = 0; h <= kHarmonics; ++h)
      lines[static_cast<std::size_t>(h)] = static_cast<double>(kSamples) * x(c, h);
    lines[0] = lines[0].real();
    transform.inverse(samples, lines, kSamples);
    for (int s = 0; s < kSamples; ++s) waves(s, c) = samples[static_cast<std::size_t>(s)];
  }
  return waves;
}

std::vector<SteadyShaft::Waves> SteadyShaft::cylinder_waves(double omega, const RayleighCase& damping) const {
  std::vector<Waves> waves;
  for (const Spectrum& force : force_) waves.push_back(respond(force, omega, damping, outputs_.rows()));
  return waves;
}

Eigen::VectorXd SteadyShaft::deflection(double omega, const RayleighCase& damping) const {
  return respond(all_, omega, damping, 1).col(0);
}

SteadyShaft::Waves in_order(const std::vector<SteadyShaft::Waves>& cylinder_waves,
                            const std::vector<int>& order, Eigen::Index first, Eigen::Index count) {
  const Eigen::Index samples = cylinder_waves.front().rows();
  const auto cylinders = static_cast<Eigen::Index>(order.size());
  SteadyShaft::Waves sum = SteadyShaft::Waves::Zero(samples, count);
  for (Eigen::Index place = 0; place < cylinders; ++place) {
    const auto& wave = cylinder_waves[static_cast<std::size_t>(order[static_cast<std::size_t>(place)] - 1)];
    const Eigen::Index shift = place * samples / cylinders;
    sum.bottomRows(samples - shift) += wave.block(0, first, samples - shift, count);
    sum.topRows(shift) += wave.block(samples - shift, first, shift, count);
  }
  return sum;
}

std::vector<std::pair<double, int>> largest_orders(const Eigen::VectorXd& wave) {
  std::vector<std::pair<double, int>> orders;
  const auto samples = static_cast<double>(wave.size());
  for (int n = 1; n <= 200; ++n) {
    Complex sum;
    for (Eigen::Index i = 0; i < wave.size(); ++i)
      sum += wave[i] * std::polar(1.0, -kTwoPi * n * static_cast<double>(i) / samples);
    orders.emplace_back(2.0 * std::abs(sum) / samples, n);
  }
  std::sort(orders.rbegin(), orders.rend());
  return orders;
}

double peak_of(const Eigen::Ref<const Eigen::VectorXd>& wave) {
  Eigen::Index at = 0;
  const double y = wave.cwiseAbs().maxCoeff(&at);
  const double sign = wave[at] < 0.0 ? -1.0 : 1.0;
  const Eigen::Index n = wave.size();
  const double left = sign * wave[(at + n - 1) % n], right = sign * wave[(at + 1) % n];
  const double bend = left - 2.0 * y + right;
  return bend < 0.0 ? y - (right - left) * (right - left) / (8.0 * bend) : y;
}

}  // namespace drev
