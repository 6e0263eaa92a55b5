// EngineCylinders: kinematics, tangents, firing orders, misfire, bad input.
#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/engine/engine_cylinders.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

/// Compression and expansion of a made-up four-stroke cylinder, firing at 0.
GasPressure::Params smooth_gas() {
  GasPressure::Params gas;
  for (int i = 0; i < 144; ++i) {
    const double a = deg(5.0 * i);
    gas.angle.push_back(a);
    gas.pressure.push_back(1e5 + 6e6 * std::exp(-2.0 * std::pow(std::sin(0.25 * (a - 0.15)), 2) * 12.0));
  }
  gas.interpolation = Interpolation::cubic;
  return gas;
}

EngineCylinders::Params engine_of(GasPressure::Params gas) {
  return {.bore = 0.105,
          .stroke = 0.137,
          .rod = 0.207,
          .oscillating_mass = 2.521,
          .rotating_mass = 1.5,
          .firing_angles = EngineCylinders::even_firing("1-3-4-2", 4, deg(10)),
          .gas = std::move(gas)};
}

}  // namespace

TEST_CASE("Crank and slider: derivatives against the position") {
  const CrankSlider crank{0.0685, 0.207};
  const auto x = [&](double a) {
    return crank.radius * std::cos(a) +
           std::sqrt(crank.rod * crank.rod - std::pow(crank.radius * std::sin(a), 2));
  };
  for (const double a : {0.0, 0.4, 1.7, 3.2, 5.9}) {
    const double h = 1e-4;
    const CrankSlider::Derivatives d = crank.at(a);
    CHECK(d.first == Approx((x(a + h) - x(a - h)) / (2 * h)).margin(1e-9));
    CHECK(d.second == Approx((x(a + h) - 2 * x(a) + x(a - h)) / (h * h)).margin(1e-8));
    CHECK(d.third == Approx((crank.at(a + h).second - crank.at(a - h).second) / (2 * h)).margin(1e-8));
  }
  // A rod of infinite length: x' = -r sin a, mean square r^2/2.
  CHECK(CrankSlider{0.1, 1e6}.mean_square() == Approx(0.005).epsilon(1e-9));
}

TEST_CASE("Engine cylinders: tangents, inertia, channels of each cylinder") {
  const EngineCylinders engine(engine_of(smooth_gas()));
  CHECK(check_element(engine, 4).failures == std::vector<std::string>{});
  const Terms terms = test::described(engine, 4);
  REQUIRE(terms.loads.size() == 4);
  CHECK(terms.loads[2].suffix == "3");
  CHECK(terms.mass(1, 1) == Approx(1.5 * 0.0685 * 0.0685));
  CHECK(engine.min_nodes() == 4);
}

TEST_CASE("Mass torque: the classical series' orders") {
  // Coefficients of sin(k a) over m r^2 w^2 for r/l = .3309179, by an exact integral of a separate program.
  const double expected[] = {.085118588, -.500420117, -.259056347, -.028962430, .006301716, .001259292};
  EngineCylinders::Params p = engine_of({});
  p.firing_angles = {0.0};
  const EngineCylinders engine(p);
  const double w = 200.0, unit = p.oscillating_mass * std::pow(0.5 * p.stroke * w, 2);
  for (int k = 1; k <= 6; ++k) {
    const double sine = test::integral([&](double a) { return engine.torque(0, a, w) * std::sin(k * a); },
                                       0.0, kTwoPi, 4096) /
                        kPi;
    CHECK(sine / unit == Approx(expected[k - 1]).margin(2e-9));
  }
}

TEST_CASE("Firing orders") {
  const std::vector<double> angles = EngineCylinders::even_firing("1-4-2-6-3-5", 4);
  const std::vector<double> expected{0, 240, 480, 120, 600, 360};
  for (std::size_t k = 0; k < 6; ++k) CHECK(to_deg(angles[k]) == Approx(expected[k]).margin(1e-12));
  CHECK(to_deg(EngineCylinders::even_firing("2-1", 2, deg(30))[0]) == Approx(210.0));
  for (const char* wrong : {"", "1-2-2", "1-3", "1,2", "0-1", "1-2-", "a"})
    CHECK_THROWS_AS(EngineCylinders::even_firing(wrong, 4), ModelError);
}

TEST_CASE("Misfire: compression stays, the mean gas torque is gone, the mass torque stays") {
  EngineCylinders::Params p = engine_of(smooth_gas());
  const double w = 150.0;
  const EngineCylinders sound(p);
  p.misfiring_cylinder = 3;
  const EngineCylinders misfires(p);
  CHECK(check_element(misfires, 4).ok());
  CHECK(sound.mean_torque(2, w) > 50.0);
  CHECK(std::abs(misfires.mean_torque(2, w)) < 1e-6);
  CHECK(misfires.mean_torque(1, w) == Approx(sound.mean_torque(1, w)).epsilon(1e-13));
  // Before its firing dead centre nothing changes.
  const double firing = p.firing_angles[2];
  CHECK(misfires.torque(2, firing - 0.3, w) == sound.torque(2, firing - 0.3, w));
  CHECK(misfires.torque(2, firing + 0.3, w) == Approx(-misfires.torque(2, firing - 0.3, w)));
}

TEST_CASE("Pressure by load and by peak pressure, tangential pressure") {
  GasPressure::Params gas;
  gas.angle = {0.0, 4.0, 8.0, 0.0, 4.0, 8.0};
  gas.pressure = {4e6, 1e5, 1e5, 8e6, 1e5, 1e5};
  gas.load = {0.5, 0.5, 0.5, 1.0, 1.0, 1.0};
  gas.at_load = 0.75;
  CHECK(GasPressure(gas, 2.0 * kTwoPi).at(0.0, 100.0, false).pressure == Approx(6e6));
  GasPressure::Params one{.angle = {0.0, 4.0, 8.0},
                          .pressure = {4e6, 1e5, 1e5},
                          .peak_speed = {100.0, 200.0},
                          .peak_pressure = {5e6, 7e6}};
  CHECK(GasPressure(one, 2.0 * kTwoPi).at(0.0, -150.0, false).pressure == Approx(6e6));
  CHECK(GasPressure(one, 2.0 * kTwoPi).at(0.0, 500.0, false).pressure == Approx(7e6));
  EngineCylinders::Params p = engine_of({});
  p.oscillating_mass = 0.0;
  p.mean_tangential_pressure = 1e6;
  p.tangential_pressure = {{0.5, 2e6, 0.2}};
  const EngineCylinders classic(p);
  CHECK(check_element(classic, 4).ok());
  const double arm = 0.25 * kPi * p.bore * p.bore * 0.5 * p.stroke;
  CHECK(classic.torque(0, deg(10) + 0.8, 99.0) == Approx(arm * (1e6 + 2e6 * std::cos(0.6))));
}

TEST_CASE("Firing gated by speed: compression alone outside, the straight mix over the ramp") {
  EngineCylinders::Params p = engine_of(smooth_gas());
  p.gas.firing = {.from_speed = 30.0, .to_speed = 260.0, .speed_ramp = 10.0};
  const EngineCylinders gated(p), fires(engine_of(smooth_gas()));
  CHECK(check_element(gated, 4).failures == std::vector<std::string>{});
  const GasPressure pressure(p.gas, 2.0 * kTwoPi), plain(smooth_gas(), 2.0 * kTwoPi);
  for (const double angle : {-0.7, -0.1, 0.2, 1.1, 4.0, 7.9}) {
    const double fired = plain.at(angle, 1.0, false).pressure, motored = plain.at(angle, 1.0, true).pressure;
    for (const auto& [speed, part] :
         {std::pair{10.0, 0.0}, {33.0, 0.3}, {-33.0, 0.3}, {150.0, 1.0}, {258.0, 0.2}, {300.0, 0.0}}) {
      INFO(angle << " " << speed);
      const double expected = motored + part * (fired - motored);
      CHECK(pressure.at(angle, speed, false).pressure == Approx(expected).epsilon(1e-13));
      CHECK(pressure.at(angle, speed, true).pressure == Approx(motored).epsilon(1e-13));
      // As curves with factors, and as a cubic between knots.
      double sum = 0.0;
      const std::vector<double> factors = pressure.factors(speed);
      for (std::size_t k = 0; k < factors.size(); ++k)
        sum += factors[k] * pressure.curve(static_cast<int>(k), angle, false);
      CHECK(sum == Approx(expected).epsilon(1e-13));
      const CubicPiece piece = pressure.piece(angle, 1.0, speed, false);
      CHECK(piece.terms[0] == Approx(expected).epsilon(1e-11));
      const double d = 0.4 * std::min(0.05, piece.high - angle);
      CHECK(piece.terms[0] + d * (piece.terms[1] + d * (piece.terms[2] + d * piece.terms[3])) ==
            Approx(pressure.at(angle + d, speed, false).pressure).epsilon(1e-10));
    }
    const double d = 1e-4;
    CHECK(
        pressure.at(angle, 35.0, false).speed_slope ==
        Approx((pressure.at(angle, 35.0 + d, false).pressure - pressure.at(angle, 35.0 - d, false).pressure) /
               (2.0 * d))
            .epsilon(1e-6)
            .margin(1e-3));
  }
  CHECK(gated.mean_torque(0, 150.0) == Approx(fires.mean_torque(0, 150.0)).epsilon(1e-12));
  CHECK(std::abs(gated.mean_torque(0, 10.0)) < 1e-6 * fires.mean_torque(0, 150.0));
  EngineCylinders::Params classic = engine_of({});
  classic.mean_tangential_pressure = 1e5;
  classic.gas.firing = p.gas.firing;
  CHECK(test::contains(test::findings(EngineCylinders(classic)), "needs curves of pressure"));
}

TEST_CASE("Engine cylinders: bad input is named, all at once") {
  EngineCylinders::Params p = engine_of(smooth_gas());
  p.rod = 0.05;
  p.strokes = 3;
  p.misfiring_cylinder = 7;
  p.oscillating_mass = -1.0;
  p.mean_tangential_pressure = 1e5;
  p.gas.load = {1.0};
  const std::string text = test::findings(EngineCylinders(p));
  for (const char* part :
       {"rod", "must be longer than 0.6 stroke", "strokes", "must be 2 or 4", "misfiring_cylinder", "1 to 4",
        "oscillating_mass", "tangential_pressure", "as many as the angles"})
    CHECK(test::contains(text, part));
  EngineCylinders::Params vacuum = engine_of(smooth_gas());
  vacuum.gas.pressure[3] = -1.2e5;
  CHECK(test::contains(test::findings(EngineCylinders(vacuum)), "must be >= -101325"));
  vacuum.gas.pressure[3] = -0.3e5;  // above that of the crankcase: an intake's
  CHECK_FALSE(test::contains(test::findings(EngineCylinders(vacuum)), "pressure"));
}
