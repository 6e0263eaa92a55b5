// Trains of freewheels, clutches and brakes whose numbers are round, so that things coincide that never do at random: torques
// that just reach a bound, speeds that meet without crossing, contacts side by side that come to rest together.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>
#include <initializer_list>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

namespace {

struct Train {
  Model model;
  bool on_ground = false;
  double impulse = 0.0;  // of what drives it over the run [N m s], the start's momentum included
};

constexpr double kEnd = 2.2;

Train random_train(unsigned seed) {
  std::mt19937 random(seed);
  const auto pick = [&](std::initializer_list<double> values) {
    return values.begin()[random() % values.size()];
  };
  Train train{Model("round numbers " + std::to_string(seed))};
  Model& m = train.model;
  const unsigned n = 2 + random() % 2;
  double speed = 0.0;
  for (unsigned i = 0; i < n; ++i) {
    const std::string number = std::to_string(i);
    const double inertia = pick({1.0, 1.0, 2.0, 0.5});
    m.add_node("n" + number);
    m.add<Inertia>("J" + number, {"n" + number}, {.inertia = inertia});
    m.set_initial("n" + number, 0.0, speed);
    train.impulse += inertia * speed;
    speed += pick({0.0, 0.5, 1.0});
  }
  const TimeTable engaged({0.3, 0.3, 0.95, 0.95, 1.6, 1.6, 2.25, 2.25},
                          {0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0});
  for (unsigned i = 0; i + 1 < n; ++i) {
    const std::string a = "n" + std::to_string(i), b = "n" + std::to_string(i + 1), k = std::to_string(i);
    if (random() % 3 != 0) m.add<Freewheel>("freewheel" + k, {a, b}, {});
    if (random() % 2 != 0)
      m.add<Clutch>("clutch" + k, {a, b},
                    {.torque = pick({1.0, 1.5, 3.0}),
                     .break_away_ratio = pick({1.0, 1.5, 25.0}),
                     .engagement = engaged});
    if (random() % 3 == 0)
      m.add<ShaftSpring>("shaft" + k, {a, b},
                         {.stiffness = pick({100.0, 1000.0}), .damping = pick({0.0, 0.5})});
  }
  train.on_ground = random() % 2 != 0;
  if (train.on_ground) m.add<BearingFriction>("bearing", {"n0"}, {.torque = pick({0.2, 0.5})});
  const double frequency = pick({1.0, 2.0, 3.0}), amplitude = pick({5.0, 10.0});
  const double phase = pick({0.0, -kPi / 2.0, kPi / 2.0}), omega = kTwoPi * frequency;
  m.add<AppliedTorque>("sine", {"n0"}, {.harmonics = {{frequency, amplitude, phase}}});
  train.impulse += amplitude / omega * (std::sin(omega * kEnd + phase) - std::sin(phase));
  if (random() % 2 != 0) {
    const double load = pick({-0.3, -1.0, 0.5});
    m.add<AppliedTorque>("load", {"n" + std::to_string(n - 1)}, {.table = TimeTable({0.0}, {load})});
    train.impulse += load * kEnd;
  }
  return train;
}

}  // namespace

TEST_CASE(
    "Friction: where round numbers coincide, the motion is the same whatever the steps, and keeps its "
    "momentum") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Train train = random_train(seed);
    const System system = train.model.build();
    Vector first;
    for (double exponent = 12.0; exponent > 6.9; exponent -= 0.35) {
      State state = State::initial(system);
      INFO(system.name() << ", tolerance 1e-" << exponent);
      RunSummary run;
      CHECK_NOTHROW(run = propagate(system, {.tolerance = std::pow(10.0, -exponent), .t_end = kEnd}, state));
      CHECK(run.ok());
      if (first.size() == 0) first = state.v;
      CHECK((state.v - first).lpNorm<Eigen::Infinity>() < 1e-4);
      double momentum = 0.0;
      for (int i = 0; i < system.size(); ++i)
        momentum += system.mass_values()[system.diagonal_slots()[static_cast<std::size_t>(i)]] * state.v[i];
      if (!train.on_ground) CHECK(momentum == Approx(train.impulse).margin(1e-5));
    }
  }
}
