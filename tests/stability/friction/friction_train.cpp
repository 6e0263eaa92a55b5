#include "tests/stability/friction/friction_train.hpp"

#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace drev::test {

namespace {

/// SplitMix64: the same numbers with every library.
class TrainRandom {
 public:
  explicit TrainRandom(std::uint64_t seed) : state_(seed) {}
  double even(double low, double high) {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    z ^= z >> 31;
    return low + (high - low) * static_cast<double>(z >> 11) * 0x1p-53;
  }
  double scaled(double low, double high) { return low * std::exp(even(0.0, std::log(high / low))); }
  bool chance(double part) { return even(0.0, 1.0) < part; }

 private:
  std::uint64_t state_;
};

void engage(TrainRandom& random, FrictionTrain::Contact& c, double duration) {
  const double t_0 = random.even(0.0, 0.4) * duration, t_1 = random.even(0.5, 0.9) * duration;
  if (random.chance(0.4))
    c.times = {t_0, t_1}, c.parts = {random.chance(0.5) ? 0.0 : 0.3, 1.0};
  else if (random.chance(0.5))
    c.times = {t_0, t_0, t_1, t_1}, c.parts = {0.0, 1.0, 1.0, random.even(0.0, 0.6)};
}

FrictionTrain::Contact random_contact(TrainRandom& random, FrictionTrain::Contact::Kind kind, int a, int b,
                                      double duration) {
  using Kind = FrictionTrain::Contact::Kind;
  FrictionTrain::Contact c{kind, a, b, random.scaled(0.5, 20.0), 1.0, 0.0, 0.0};
  if (kind == Kind::freewheel) return c;
  if (random.chance(0.35)) c.break_away = random.even(1.0, 1.6);
  if (random.chance(0.4)) {
    c.knot_speed = random.even(1.0, 15.0);
    c.far_torque = c.torque * random.even(0.6, 1.3);
  }
  if (kind == Kind::clutch || kind == Kind::brake) engage(random, c, duration);
  return c;
}

FrictionTrain::Gear random_gear(TrainRandom& random, int a, int b) {
  const bool bearing = random.chance(0.6);
  const auto loss = [&] {
    return FrictionTrain::Gear::Loss{random.even(0.3, 1.0), random.even(0.1, 1.0),
                                     bearing ? random.even(0.0, 3.0) : 0.0,
                                     bearing ? random.even(0.0, 3.0) : 0.0};
  };
  FrictionTrain::Gear gear{a, b, (random.chance(0.5) ? 1.0 : -1.0) * random.scaled(0.3, 3.0), loss()};
  if (random.chance(0.3)) gear.knot_speed = random.even(1.0, 15.0), gear.far = loss();
  return gear;
}

}  // namespace

FrictionTrain random_friction_train(unsigned seed, bool break_away_in_loops) {
  using Kind = FrictionTrain::Contact::Kind;
  TrainRandom random(1000003ull * seed + 17);
  FrictionTrain train;
  const int n = 2 + static_cast<int>(random.even(0.0, 3.999));
  for (int i = 0; i < n; ++i) {
    train.inertia.push_back(random.scaled(0.02, 1.0));
    train.angle.push_back(0.0);
    train.speed.push_back(random.chance(0.3) ? 0.0 : random.even(-15.0, 15.0));
    train.drives.push_back({random.even(-10.0, 10.0), random.chance(0.7) ? random.scaled(1.0, 30.0) : 0.0,
                            random.scaled(1.0, 40.0)});
  }
  for (int i = 0; i + 1 < n; ++i) {
    const double which = random.even(0.0, 1.0);
    if (random.chance(0.3)) {
      train.gears.push_back(random_gear(random, i, i + 1));
      train.speed[idx(i + 1)] = train.gears.back().ratio * train.speed[idx(i)];
    } else if (which < 0.5) {
      const bool gap = random.chance(0.4);
      train.springs.push_back({i, i + 1, random.scaled(1e2, 1e4), gap ? 0.0 : random.even(0.0, 0.5),
                               gap ? random.scaled(1e-3, 2e-2) : 0.0});
    } else if (which < 0.75) {
      train.contacts.push_back(random_contact(random, Kind::clutch, i, i + 1, train.duration));
    } else if (which < 0.87) {
      train.contacts.push_back(random_contact(random, Kind::joint, i, i + 1, train.duration));
    } else {
      train.contacts.push_back(random_contact(random, Kind::freewheel, i, i + 1, train.duration));
      train.speed[idx(i + 1)] = std::max(train.speed[idx(i)], train.speed[idx(i + 1)]);
      if (random.chance(0.3))
        train.contacts.push_back(random_contact(random, Kind::clutch, i, i + 1, train.duration));
    }
  }
  for (int i = 0; i < n; ++i) {
    if (random.chance(0.35))
      train.contacts.push_back(random_contact(random, Kind::bearing, i, -1, train.duration));
    if (random.chance(0.2))
      train.contacts.push_back(random_contact(random, Kind::brake, i, -1, train.duration));
  }
  if (train.contacts.empty() && train.gears.empty())
    train.contacts.push_back(random_contact(random, Kind::brake, 0, -1, train.duration));
  std::vector<int> part(idx(n + 1));
  for (int i = 0; i <= n; ++i) part[idx(i)] = i;
  bool loop = false;
  const auto join = [&](int first, int second) {
    const int a = part[idx(first)], b = part[idx(second < 0 ? n : second)];
    loop = loop || a == b;
    std::replace(part.begin(), part.end(), a, b);
  };
  for (const FrictionTrain::Contact& c : train.contacts) join(c.a, c.b);
  for (const FrictionTrain::Gear& g : train.gears) join(g.a, g.b), join(g.a, -1);  // it holds itself, too
  for (FrictionTrain::Contact& c : train.contacts)
    if (loop && !break_away_in_loops) c.break_away = 1.0;
  return train;
}

Model to_model(const FrictionTrain& train) {
  using Kind = FrictionTrain::Contact::Kind;
  Model m("friction train");
  const auto name = [](int i) { return "n" + std::to_string(i); };
  for (int i = 0; i < static_cast<int>(train.inertia.size()); ++i) {
    const auto k = idx(i);
    m.add_node(name(i));
    m.add<Inertia>("J" + std::to_string(i), {name(i)}, {.inertia = train.inertia[k]});
    m.set_initial(name(i), train.angle[k], train.speed[k]);
    const FrictionTrain::Drive& d = train.drives[k];
    m.add<AppliedTorque>("mean" + std::to_string(i), {name(i)}, {.table = TimeTable({0.0}, {d.mean})});
    if (d.amplitude > 0.0)
      m.add<AppliedTorque>("drive" + std::to_string(i), {name(i)},
                           {.harmonics = {{d.frequency_Hz, d.amplitude, 0.0}}});
  }
  for (std::size_t i = 0; i < train.springs.size(); ++i) {
    const FrictionTrain::Spring& s = train.springs[i];
    const std::vector<NodeRef> nodes{name(s.a), name(s.b)};
    if (s.half_gap > 0.0)
      m.add("spring" + std::to_string(i), nodes,
            std::make_shared<PolylineSpring>(PolylineSpring::dead_band(s.stiffness, s.half_gap, 0.0)));
    else
      m.add(
          "spring" + std::to_string(i), nodes,
          std::make_shared<ShaftSpring>(ShaftSpring::Params{.stiffness = s.stiffness, .damping = s.damping}));
  }
  for (std::size_t i = 0; i < train.gears.size(); ++i) {
    const FrictionTrain::Gear& g = train.gears[i];
    LossyGear::Params p{.ratio = g.ratio};
    if (g.knot_speed > 0.0) {
      p.speeds = {0.0, g.knot_speed};
      p.efficiencies_forward = {g.loss.forward, g.far.forward};
      p.efficiencies_backward = {g.loss.backward, g.far.backward};
      p.bearing_torques_forward = {g.loss.bearing_forward, g.far.bearing_forward};
      p.bearing_torques_backward = {g.loss.bearing_backward, g.far.bearing_backward};
    } else {
      p.efficiency_forward = g.loss.forward, p.efficiency_backward = g.loss.backward;
      p.bearing_torque_forward = g.loss.bearing_forward, p.bearing_torque_backward = g.loss.bearing_backward;
    }
    m.add<LossyGear>("gear" + std::to_string(i), {name(g.a), name(g.b)}, std::move(p));
  }
  for (std::size_t i = 0; i < train.contacts.size(); ++i) {
    const FrictionTrain::Contact& c = train.contacts[i];
    std::vector<NodeRef> nodes{name(c.a)};
    if (c.b >= 0) nodes.push_back(name(c.b));
    DryFriction::Params p{.break_away_ratio = c.break_away};
    if (c.knot_speed > 0.0)
      p.slip_speeds = {0.0, c.knot_speed}, p.sliding_torques = {c.torque, c.far_torque};
    else
      p.torque = c.torque;
    if (!c.times.empty()) p.engagement = TimeTable(c.times, c.parts);
    std::shared_ptr<const Element> element;
    if (c.kind == Kind::freewheel)
      element = std::make_shared<Freewheel>(Freewheel::Params{});
    else if (c.kind == Kind::clutch)
      element = std::make_shared<Clutch>(p);
    else if (c.kind == Kind::brake)
      element = std::make_shared<Brake>(p);
    else if (c.kind == Kind::joint)
      element = std::make_shared<CoulombJoint>(p);
    else
      element = std::make_shared<BearingFriction>(p);
    m.add("contact" + std::to_string(i), nodes, std::move(element));
  }
  return m;
}

namespace {

double train_difference(const std::vector<double>& a, const Vector& b) {
  double largest = 1e-3, difference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i]));
    difference = std::max(difference, std::abs(a[i] - b[static_cast<Eigen::Index>(i)]));
  }
  return difference / largest;
}

}  // namespace

namespace {

RunSummary run_train(const System& system, const FrictionTrain& train, double more, State& state) {
  state = State::initial(system);
  for (Eigen::Index i = 0; i < state.v.size(); ++i)
    if (state.v[i] != 0.0) state.v[i] *= 1.0 + more;
  return propagate(system, {.tolerance = 1e-12, .t_end = train.duration, .energy_tolerance = 1e-9}, state);
}

void enter(const RunSummary& summary, FrictionVerdict& verdict) {
  verdict.changes = summary.friction_changes;
  verdict.steps = summary.steps;
  if (summary.energy.scale > 1e-9) verdict.energy_error = summary.energy.relative_error();
  if (!summary.ok()) verdict.failure = summary.reason;
}

}  // namespace

FrictionVerdict judge(const FrictionTrain& train) {
  FrictionVerdict verdict;
  try {
    const System system = to_model(train).build();
    State state, near;
    enter(run_train(system, train, 0.0, state), verdict);
    run_train(system, train, 1e-9, near);
    const FrictionMotion own = integrate(train, 5e-6);
    verdict.events = own.events;
    verdict.difference = std::max(train_difference(own.angle, state.z), train_difference(own.speed, state.v));
    const std::vector<double> z(state.z.begin(), state.z.end()), v(state.v.begin(), state.v.end());
    verdict.sensitivity = std::max(train_difference(z, near.z), train_difference(v, near.v));
  } catch (const std::exception& error) {
    verdict.failure = error.what();
  }
  return verdict;
}

FrictionVerdict judge_alone(const FrictionTrain& train) {
  FrictionVerdict verdict;
  try {
    const System system = to_model(train).build();
    State state;
    enter(run_train(system, train, 0.0, state), verdict);
  } catch (const std::exception& error) {
    verdict.failure = error.what();
  }
  return verdict;
}

}  // namespace drev::test
