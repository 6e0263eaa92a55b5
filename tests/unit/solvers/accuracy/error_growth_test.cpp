// Growth of small differences against closed forms and a published chaotic oscillator.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>

#include <cmath>

#include "solvers/accuracy/student.hpp"
#include "tests/catch.hpp"
#include "tests/problems/chaotic_oscillator.hpp"

using namespace drev;

TEST_CASE("Growth: a damped oscillator forgets, as exp(-c t / 2 m)") {
  Model m("damped");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<GroundSpring>("spring", {"m"}, {.stiffness = 25.0});
  m.add<Dashpot>("c", {"m"}, {.damping = 0.2});
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  const ErrorGrowth g =
      measure_error_growth(system, {.method = {.name = "exact", .tolerance = 1e-13}, .t_end = 200.0});
  CHECK(g.status == RunStatus::success);
  CHECK(g.t.size() == 400);
  CHECK(std::abs(g.rate + 0.1) < 0.01);
  CHECK(g.growth.back() < 3.0);
  CHECK(g.time_of(10.0) == HUGE_VAL);
}

TEST_CASE("Growth: none in linear trains, though they drift or have stiff shafts", "[once]") {
  // Free, pushed by a sine from its zero: the pair drifts by some 10 rad a second and twists by 1e-2 rad. Held, with a shaft
  // 1e5 times as stiff as the others: 1e-9 of the largest angle in it would be 300 times as much of the rates.
  Model drifting("free pair");
  for (const auto& [node, inertia] : {std::pair("a", 0.012), {"b", 0.035}}) {
    drifting.add_node(node);
    drifting.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
  }
  drifting.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 8500.0, .damping = 0.5});
  drifting.add<AppliedTorque>("drive", {"a"}, {.harmonics = {{40.0, 20.0, -kPi / 2}}});
  Model stiff("stiff coupling");
  for (const char* node : {"a", "b", "c"}) {
    stiff.add_node(node);
    stiff.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 0.1});
  }
  stiff.add<GroundSpring>("hold", {"a"}, {.stiffness = 1e3});
  stiff.add<ShaftSpring>("soft", {"a", "b"}, {.stiffness = 1e3, .damping = 0.01});
  stiff.add<ShaftSpring>("stiff", {"b", "c"}, {.stiffness = 1e8});
  stiff.add<AppliedTorque>("drive", {"c"}, {.harmonics = {{5.0, 20.0, 0.0}}});
  for (const auto& [model, times] :
       {std::pair(drifting, std::vector{1.7, 12.0, 18.6}), {stiff, std::vector{0.4, 1.7}}})
    for (const double t_end : times) {
      const ErrorGrowth g = measure_error_growth(
          model.build(), {.method = {.name = "exact", .tolerance = 1e-12}, .t_end = t_end, .pieces = 40});
      INFO(model.name() << " over " << t_end << " s");
      CHECK(g.status == RunStatus::success);
      CHECK(g.growth.back() < 5.0);
    }
}

TEST_CASE("Growth: largest Lyapunov exponent of the chaotic gear pair", "[once]") {
  // Published: 0.10947 a unit of time.
  const ErrorGrowth g = measure_error_growth(
      chaotic_oscillator(),
      {.method = {.name = "exact", .tolerance = 1e-13}, .t_end = 2000 * kTwoPi, .pieces = 4000});
  CHECK(g.status == RunStatus::success);
  CHECK(g.rate == Approx(0.10947).margin(std::max(0.003, 1.5 * g.rate_error)));
  CHECK(g.rate_error < 0.01);
  // 1e-12 grows to 0.05 after 31 to 41 periods.
  const double periods = g.time_of(0.05 / 1e-12) / kTwoPi;
  CHECK(periods > 25.0);
  CHECK(periods < 50.0);
}

TEST_CASE("Growth: controlled steps, which differ for states that hardly do, give the exponent too") {
  const ErrorGrowth g = measure_error_growth(
      chaotic_oscillator(),
      {.method = {.name = "dormand_prince", .tolerance = 1e-4}, .t_end = 500 * kTwoPi, .pieces = 1000});
  CHECK(g.status == RunStatus::success);
  CHECK(g.rate == Approx(0.10947).margin(std::max(0.003, 1.5 * g.rate_error)));
  CHECK(g.rate_error < 0.02);
}

TEST_CASE("Batch means: interval of independent samples") {
  // 0, 1, 0, 1, ...: every batch of an even number has mean 1/2.
  std::vector<double> even(400);
  for (std::size_t i = 0; i < even.size(); ++i) even[i] = static_cast<double>(i % 2);
  CHECK(batch_mean(even).value == Approx(0.5));
  CHECK(batch_mean(even).error == Approx(0.0).margin(1e-15));
  // Two batches 1 and 3: mean 2, s / sqrt(2) = 1, t(1 degree) = 12.706.
  const Estimate two = batch_mean({1.0, 3.0}, 2);
  CHECK(two.value == 2.0);
  CHECK(two.error == Approx(12.706));
  CHECK(two.kind == Estimate::Kind::interval);
  CHECK(std::isinf(batch_mean({1.0}).error));
}

TEST_CASE("Student's t: quantiles of the table and beyond it, published ones") {
  // Abramowitz and Stegun, 1964, table 26.10.
  CHECK(student_95(1.0) == Approx(12.706));
  CHECK(student_95(20.0) == Approx(2.086));
  CHECK(student_95(21.0) == Approx(2.080).epsilon(1e-3));
  CHECK(student_95(30.0) == Approx(2.042).epsilon(1e-3));
  CHECK(student_95(120.0) == Approx(1.980).epsilon(1e-3));
  CHECK(student_95(INFINITY) == Approx(1.960).epsilon(1e-4));
}
