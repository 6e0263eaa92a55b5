// Clutch, Brake, CoulombJoint, BearingFriction, Freewheel: parameters, tables, bad input.
#include <drev/core/element.hpp>
#include <drev/elements/friction/bearing_friction.hpp>
#include <drev/elements/friction/brake.hpp>
#include <drev/elements/friction/clutch.hpp>
#include <drev/elements/friction/coulomb_joint.hpp>
#include <drev/elements/friction/freewheel.hpp>
#include <drev/elements/friction/lossy_gear.hpp>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

TEST_CASE("Dry friction: sliding torques by torque, table and coefficient") {
  const Clutch clutch({.slip_speeds = {0.0, 50.0},
                       .normal_force = 1000.0,
                       .geometry = 0.2,
                       .friction_coefficients = {0.4, 0.3},
                       .break_away_ratio = 1.2,
                       .engagement = TimeTable({1.0, 2.0}, {0.0, 1.0})});
  CHECK(check_element(clutch, 2).failures == std::vector<std::string>{});
  CHECK(clutch.sliding_torques() == std::vector<double>{80.0, 60.0});
  CHECK(clutch.engagement(1.5).terms[0] == 0.5);
  CHECK(clutch.engagement(1.5).terms[1] == 1.0);
  CHECK(clutch.breakpoints() == std::vector<double>{1.0, 2.0});
  const Terms terms = test::described(clutch, 2);
  REQUIRE(terms.frictions.size() == 1);
  CHECK(terms.frictions[0].b[0] == -1.0);  // the slip speed is that of the second node against the first
  CHECK(Brake({.torque = 3.0}).sliding_torques() == std::vector<double>{3.0});
  CHECK(Freewheel({}).one_way());
}

TEST_CASE("Dry friction: bad input is named") {
  const auto findings = [](DryFriction::Params p) { return test::findings(CoulombJoint(std::move(p))); };
  CHECK(test::contains(findings({}), "exactly one of"));
  CHECK(test::contains(findings({.torque = -1.0}), "must be >= 0"));
  CHECK(test::contains(findings({.torque = 1.0, .normal_force = 5.0}), "friction_coefficient"));
  CHECK(test::contains(findings({.friction_coefficient = 0.3}), "geometry"));
  CHECK(test::contains(findings({.slip_speeds = {1.0, 2.0}, .sliding_torques = {1.0, 2.0}}), "begin at 0"));
  CHECK(test::contains(findings({.slip_speeds = {0.0}, .sliding_torques = {1.0, 2.0}}), "as many"));
  CHECK(test::contains(findings({.torque = 1.0, .break_away_ratio = 0.9}), "must be finite and >= 1"));
  CHECK(test::contains(findings({.torque = 1.0, .engagement = TimeTable({0.0}, {-1.0})}), "engagement"));
}

TEST_CASE("Lossy gear: terms, table, bad input") {
  const LossyGear gear({.ratio = -0.5,
                        .speeds = {0.0, 10.0},
                        .efficiencies_forward = {0.9, 0.95},
                        .efficiencies_backward = {0.8, 0.9}});
  CHECK(check_element(gear, 2).failures == std::vector<std::string>{});
  CHECK(gear.gear_loss()->bearing_forward == std::vector<double>{0.0, 0.0});
  const Terms terms = test::described(gear, 2);
  REQUIRE(terms.frictions.size() == 2);
  CHECK(terms.frictions[0].friction->rigid());
  CHECK(terms.frictions[0].b == LocalRow(Eigen::Vector2d(1.0, 2.0)));
  CHECK(terms.frictions[1].b == LocalRow(Eigen::Vector2d(1.0, 0.0)));
  const auto findings = [](LossyGear::Params p) { return test::findings(LossyGear(std::move(p))); };
  const auto of = [&](double forward, double backward, double bearing_backward = 0.0) {
    return findings({.ratio = 1.0,
                     .efficiency_forward = forward,
                     .efficiency_backward = backward,
                     .bearing_torque_backward = bearing_backward});
  };
  CHECK(of(0.9, 0.8).empty());
  CHECK(of(0.9, -0.3).empty());
  CHECK(test::contains(findings({}), "ratio = NaN"));
  CHECK(test::contains(of(0.0, 0.5), "must be > 0 and <= 1"));
  CHECK(test::contains(of(0.9, 1.1), "must be finite and <= 1"));
  CHECK(test::contains(of(0.9, 0.5, -1.0), "must be >= 0"));
  CHECK(test::contains(of(0.9, -0.3, 1.0), "give power"));
  CHECK(test::contains(findings({.ratio = 1.0, .speeds = {0.0, 1.0}, .efficiencies_forward = {0.9}}),
                       "must be as many as speeds"));
  CHECK(test::contains(findings({.ratio = 1.0,
                                 .efficiency_forward = 0.9,
                                 .speeds = {1.0},
                                 .efficiencies_forward = {0.9},
                                 .efficiencies_backward = {0.9}}),
                       "must begin at 0"));
}
