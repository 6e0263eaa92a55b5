// Figures with their errors against closed forms.
// Covers solvers/accuracy/accuracy_observers.hpp, solvers/accuracy/run_statistics.hpp and solvers/run/estimate.hpp
// through run_to_accuracy(), solvers/accuracy/processor_time.hpp.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

namespace {

void covers(const AccuracyResult& r, const std::string& name, double truth) {
  const Figure* f = r.find(name);
  INFO(name);
  REQUIRE(f != nullptr);
  INFO(f->value << " +- " << f->error << ", truth " << truth);
  CHECK(std::abs(f->value - truth) <= f->error);
}

}  // namespace

TEST_CASE("Accuracy: a damped oscillator let go at 1, by exact, constant and controlled steps") {
  // x = e^(-d t) (cos w t + d/w sin w t), d = 0.3, w^2 + d^2 = 4 pi^2; the dashpot's force is 0.6 x'.
  Model m = unit_oscillator();
  m.add<Dashpot>("c", {"m"}, {.damping = 0.6});
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  const double d = 0.3, w = std::sqrt(4 * kPi * kPi - d * d);
  // x' = -(w^2 + d^2)/w e^(-d t) sin w t, largest at tan w t = w / d.
  const double t = std::atan2(w, d) / w;
  const double force = 0.6 * (w * w + d * d) / w * std::exp(-d * t) * std::sin(w * t);
  for (const Method& method : {Method{.name = "exact"}, Method{.step = 1e-3},
                               Method{.name = "dormand_prince", .tolerance = kControlledTolerance},
                               Method{.name = "sdirk4", .tolerance = kControlledTolerance}})
    for (const double accuracy : {1e-3, 1e-6}) {
      INFO(method.name << " to " << accuracy);
      const AccuracyResult r = run_to_accuracy(system, {.accuracy = accuracy,
                                                        .t_end = 3.0,
                                                        .deflection = "m.position_m",
                                                        .torques = {"c.force_N"},
                                                        .method = method});
      CHECK(r.reached);
      CHECK(r.horizon == HUGE_VAL);
      covers(r, "peak deflection", 1.0);
      covers(r, "peak torque", force);
      for (const Figure& f : r.figures) CHECK(f.keeps(accuracy));
    }
}

TEST_CASE("Accuracy: the error of the state that a run starts from is in every figure") {
  // The oscillator above, let go at 1.0001 where 1 is meant: all of it is 1e-4 off.
  Model m = unit_oscillator();
  m.add<Dashpot>("c", {"m"}, {.damping = 0.6});
  m.set_initial("m", 1.0 + 1e-4, 0.0);
  const System system = m.build();
  const double d = 0.3, w = std::sqrt(4 * kPi * kPi - d * d), t = std::atan2(w, d) / w;
  const double force = 0.6 * (w * w + d * d) / w * std::exp(-d * t) * std::sin(w * t);
  AccuracyOptions options{
      .accuracy = 1e-6, .t_end = 3.0, .deflection = "m.position_m", .torques = {"c.force_N"}};
  options.method = {.name = "exact"};
  const AccuracyResult unaware = run_to_accuracy(system, options);
  CHECK(unaware.reached);
  CHECK(std::abs(unaware.find("peak torque")->value - force) > 100 * unaware.find("peak torque")->error);
  options.start_error = 1.1e-4;
  const AccuracyResult r = run_to_accuracy(system, options);
  covers(r, "peak deflection", 1.0);
  covers(r, "peak torque", force);
  CHECK_FALSE(r.reached);
  CHECK(r.reason.find("the state it starts from has an error of 0.00011") != std::string::npos);
  options.accuracy = 1e-3;
  CHECK(run_to_accuracy(system, options).reached);
  options.start_error = -1.0;
  CHECK_THROWS_AS(run_to_accuracy(system, options), ModelError);
}

TEST_CASE("Accuracy: times of contact of a ball between two walls, and order amplitudes") {
  // Free within +-1 at speed 2, k = pi^2, m = 1: in contact for half a period of omega = pi, 1 s.
  Model m("ball");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<PolylineSpring>("walls", {"m"}, PolylineSpring::dead_band(kPi * kPi, 1.0));
  m.set_initial("m", 0.0, 2.0);
  const System system = m.build();
  // 0.5 s to the wall, then 1 s in it, 1 s through the gap: period 4 s.
  const AccuracyResult r = run_to_accuracy(system, {.accuracy = 1e-8,
                                                    .t_end = 20.0,
                                                    .deflection = "m.position_m",
                                                    .torques = {"walls.force_N"},
                                                    .cycle = 4.0,
                                                    .method = {.name = "exact"}});
  CHECK(r.reached);
  covers(r, "peak deflection", 1.0 + 2.0 / kPi);
  covers(r, "peak torque", 2.0 * kPi);
  covers(r, "first contact change", 0.5);
  covers(r, "last comparable contact change", 19.5);
  covers(r, "contact changes, comparable", 20.0);
  // First order: odd about 0, b = 2 (2/4) int x sin(pi t / 2) over half a period, x even about t = 1.
  const double gap = 2.0 * ([] {
                       const double a = kPi / 2;  // int_0^0.5 2 t sin(a t) dt
                       return 2.0 * (std::sin(a * 0.5) / (a * a) - 0.5 * std::cos(a * 0.5) / a);
                     })();
  const double wall = [] {  // int_0.5^1.5 (1 + 2/pi sin(pi (t - 0.5))) sin(a t) dt, by Simpson's rule
    double sum = 0.0;
    for (int i = 0; i <= 2000; ++i) {
      const double t = 0.5 + i / 2000.0;
      const double y = (1.0 + 2.0 / kPi * std::sin(kPi * (t - 0.5))) * std::sin(kPi / 2 * t);
      sum += y * (i == 0 || i == 2000 ? 1.0 : i % 2 ? 4.0 : 2.0);
    }
    return sum / 6000.0;
  }();
  const Figure* order = r.find("amplitude of order 1 ");
  REQUIRE(order != nullptr);
  // What sampling folds back onto it is the rest: 128 samples a cycle of a spectrum that falls as 1/n^4.
  CHECK(order->value == Approx(gap + wall).epsilon(1e-6));
}

TEST_CASE("Accuracy: every fault of the options at once") {
  try {
    run_to_accuracy(unit_oscillator().build(), {.accuracy = 2.0, .t_end = 0.0, .cycle = -1.0, .ensemble = 1});
    FAIL("nothing was refused");
  } catch (const ModelError& error) {
    CHECK(error.findings().size() == 6);  // from, too: not before an end at 0
    // The default method has no step: what there is to set is said.
    const std::string text = error.what();
    for (const char* part : {"method.step = 0 s", "method.tolerance > 0", "\"exact\""})
      CHECK(text.find(part) != std::string::npos);
  }
}
