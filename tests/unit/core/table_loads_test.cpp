// Tables looked up together give what each gives alone.
#include <drev/core/table_loads.hpp>
#include <drev/elements/cam_torque.hpp>

#include <cmath>
#include <deque>
#include <limits>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A table whose angles are written down with few digits.
PeriodicTable uneven(std::size_t n, double first, double period) {
  std::vector<double> u, v;
  for (std::size_t i = 0; i < n; ++i) {
    const double place = static_cast<double>(i) / static_cast<double>(n);
    u.push_back(first + std::round(1e4 * place * period) / 1e4);
    v.push_back(std::sin(kTwoPi * place) + 0.3 * std::cos(3.0 * kTwoPi * place));
  }
  return PeriodicTable(std::move(u), std::move(v), period);
}

}  // namespace

TEST_CASE("Table loads at once give what each gives alone, and a bound of their slopes") {
  const PeriodicTable a = uneven(720, 0.0, kTwoPi), b = uneven(7, -0.4, 2.0 * kTwoPi);
  std::deque<CamTorque> cams;
  TableLoads loads;
  const double ratio = -1.5, coeff = 0.7;
  for (int i = 0; i < 70; ++i) {  // more than one block
    cams.emplace_back(CamTorque::Params{.angle_table = i % 3 ? a : b, .phase = 0.37 * i});
    loads.add(*cams.back().table(), 69 - i, coeff, ratio, i % 2 ? coeff : 0.0);
  }
  TableLoads::Values values(loads);
  std::vector<double> z(70), moved(70);
  for (std::size_t i = 0; i < 70; ++i) {
    z[i] = 0.0113 * static_cast<double>(i * i);
    moved[i] = z[i] + 1e-5;
  }
  for (const double phi : {0.0, -123.456, 1e6, 2.0 * kTwoPi - 1e-12}) {
    loads.set_nominal(phi, values);
    loads.look_up(z.data(), values);
    const double bound = 1e-5 * values.steepest;
    std::vector<double> p(70);
    loads.add_to(values, p.data());
    double most = 0.0;
    for (std::size_t e = 0; e < 70; ++e) {
      const auto alone = [&](const std::vector<double>& at) {
        const double gain = e % 2 ? coeff : 0.0;
        return coeff *
               cams[e].evaluate({.nominal_angle = ratio * phi, .deviation = gain * at[69 - e]}).torque;
      };
      CHECK(p[69 - e] == Approx(alone(z)).margin(1e-13 * (1.0 + std::abs(phi))));
      most = std::max(most, std::abs(alone(moved) - alone(z)));
    }
    CHECK(bound >= most * (1.0 - 1e-4));  // 1e-10 of rounding at phi = 1e6
    CHECK(bound < 20.0 * most);
  }
}

TEST_CASE("Table loads on knots, between periods, and where the argument is no number") {
  const PeriodicTable table({0.0, 1.1, 2.0, 2.9}, {1.0, 3.0, -2.0, 5.0}, 4.0);
  const CamTorque cam({.angle_table = table});
  TableLoads loads;
  for (int i = 0; i < 6; ++i) loads.add(*cam.table(), i, 1.0, 1.0, 1.0);
  TableLoads::Values values(loads);
  loads.set_nominal(0.0, values);
  const std::vector<double> z{0.0, 1.1, -1.1, 4.0, 3.45, std::numeric_limits<double>::quiet_NaN()};
  loads.look_up(z.data(), values);
  CHECK(values.torque[0] == 1.0);
  CHECK(values.torque[1] == Approx(3.0));
  CHECK(values.torque[2] == Approx(5.0));
  CHECK(values.torque[3] == Approx(1.0));
  CHECK(values.torque[4] == Approx(3.0));
  CHECK(std::isnan(values.torque[5]));
}
