// Does the stated error cover the true one? Random linear and contact models, each to several accuracies;
// truth by a much tighter exact run, whose own statement is far below.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>

#include <cmath>
#include <random>

#include "tests/catch.hpp"
#include "tests/problems/chaotic_oscillator.hpp"

using namespace drev;

namespace {

/// A chain of 1 to 5 discs, tied to ground by a spring or by a backlash, driven by tables and orders.
System random_chain(unsigned seed, bool contacts) {
  std::mt19937 engine(seed);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Model m("chain " + std::to_string(seed));
  const int discs = 1 + static_cast<int>(engine() % 5);
  std::string last;
  for (int i = 0; i < discs; ++i) {
    const std::string n = "n" + std::to_string(i);
    m.add_node(n);
    m.add<Inertia>("J" + n, {n}, {.inertia = random(0.5, 3.0)});
    const double k = random(20.0, 300.0);
    const std::vector<NodeRef> ends = i == 0 ? std::vector<NodeRef>{n} : std::vector<NodeRef>{last, n};
    if (contacts && (i == 0 || engine() % 2))
      m.add("spring" + n, ends,
            std::make_shared<PolylineSpring>(PolylineSpring::dead_band(k, random(0.005, 0.05))));
    else if (i == 0)
      m.add<GroundSpring>("spring" + n, {n}, {.stiffness = k});
    else
      m.add<ShaftSpring>("spring" + n, {last, n}, {.stiffness = k});
    if (engine() % 2) m.add<Dashpot>("dashpot" + n, {n}, {.damping = random(0.05, 0.5)});
    last = n;
  }
  const double torque = random(1.0, 10.0);
  m.add<AppliedTorque>("load", {last},
                       {.table = TimeTable({0.0, 0.5, 1.0, 1.0}, {0.0, torque, -torque, 0.0})});
  m.set_initial("n0", random(-0.1, 0.1), random(-1.0, 1.0));
  return m.build();
}

}  // namespace

TEST_CASE("Accuracy: the stated error covers the true one on 80 random models") {
  long figures = 0, missed = 0, reached = 0;
  for (unsigned seed = 1; seed <= 80; ++seed) {
    const System system = random_chain(seed, seed % 2 == 0);
    const std::string last = system.node_names().back();
    AccuracyOptions o{.t_end = 3.0, .deflection = last + ".angle_rad", .torques = {"springn0.torque_Nm"}};
    o.method = {.name = "exact"};
    o.accuracy = 1e-10;
    const AccuracyResult truth = run_to_accuracy(system, o);
    REQUIRE(truth.summary.ok());
    for (const bool exact : {true, false})
      for (const double accuracy : {1e-3, 1e-5}) {
        o.method = exact ? Method{.name = "exact"} : Method{.step = 2e-3};
        o.accuracy = accuracy;
        o.most_seconds = 0.2;
        const AccuracyResult r = run_to_accuracy(system, o);
        INFO("seed " << seed << ", " << o.method.name << " to " << accuracy);
        REQUIRE(r.summary.ok());
        reached += r.reached;
        for (const Figure& f : r.figures) {
          if (f.kind != Figure::Kind::estimate || f.name.starts_with("last")) continue;
          const Figure* t = truth.find(f.name);
          if (t == nullptr || t->kind != Figure::Kind::estimate) continue;
          if (f.name == "contact changes, comparable") continue;  // says how far, not how much
          INFO(f.name << ": " << f.value << " +- " << f.error << ", truth " << t->value << " +- "
                      << t->error);
          ++figures;
          const bool covered = std::abs(f.value - t->value) <= f.error + t->error;
          missed += !covered;
          // An estimate may miss, but not by much, and what is said to be reached is.
          CHECK(std::abs(f.value - t->value) <= 3.0 * f.error + t->error);
          if (r.reached) CHECK(std::abs(f.value - t->value) <= accuracy * t->scale);
        }
      }
  }
  CHECK(figures > 900);
  CHECK(reached > 200);
  INFO(missed << " of " << figures);
  CHECK(missed <= figures / 100);
}

TEST_CASE("Accuracy: past the horizon the chaotic oscillator is given by its statistics") {
  const AccuracyResult r = run_to_accuracy(chaotic_oscillator(), {.accuracy = 1e-4,
                                                                  .t_end = 1000 * kTwoPi,
                                                                  .deflection = "x-hub.twist_rad",
                                                                  .torques = {"stop.torque_Nm"},
                                                                  .cycle = kTwoPi,
                                                                  .method = {.name = "exact"}});
  CHECK(r.summary.ok());
  CHECK_FALSE(r.reached);
  // 1e-14 or so grows to 1e-4 within ln(1e10)/0.10947 = 210, about.
  CHECK(r.horizon > 120.0);
  CHECK(r.horizon < 350.0);
  CHECK(r.growth.rate == Approx(0.10947).margin(std::max(0.003, 1.5 * r.growth.rate_error)));
  // Standard errors of 5000 periods, and intervals of two of them: 3 sigma of both together. (16 runs of 2000 periods, by dormand_prince
  // or exactly, have means of 0.3847 and 0.3858 with standard errors of 0.0015.)
  const auto agrees = [&](const std::string& name, double truth, double standard_error) {
    const double interval = 2.0 * standard_error;
    const Figure* f = r.find(name);
    INFO(name);
    REQUIRE(f != nullptr);
    INFO(f->value << " +- " << f->error);
    CHECK(f->kind == Figure::Kind::interval);
    CHECK(std::abs(f->value - truth) < 1.5 * std::hypot(f->error, interval));
    CHECK(f->error < 5 * interval);
  };
  agrees("mean of x-hub", 0.3926, 0.0039);
  agrees("rms of x-hub", std::hypot(0.3926, 0.9676), 0.0042);
  agrees("stop: share of time separated", 0.5816, 0.0036);
  agrees("1 % quantile", -1.849, 0.009);
  agrees("99 % quantile", 1.996, 0.005);
  CHECK(r.find("peak deflection, mean of 8 runs") != nullptr);
  const Figure* last = r.find("last comparable contact change");
  REQUIRE(last != nullptr);
  CHECK(last->keeps(1e-4));
  CHECK(last->value < r.horizon);
}
