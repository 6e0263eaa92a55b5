// Covers solvers/exact/expanded_laws.hpp and law_work.hpp, law_offsets.hpp through propagate(): laws that are products of
// series, against closed forms; and what a jump leaves of a bound.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/problems/mesh_laws.hpp"

using namespace drev;

namespace {

/// A disc of inertia J on base radius 1 m against a gear that turns as given.
Model disc_on_mesh(double inertia, double speed, GearMesh::Params mesh) {
  Model m("disc");
  m.add_node("given");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
  mesh.base_radius_1 = mesh.base_radius_2 = 1.0;
  m.add<GearMesh>("mesh", {"given", "disc"}, std::move(mesh));
  m.constant_speed("given", speed);
  return m;
}

/// Compares the ranges that forces of laws are said to have, or to stay in, with what they are inside each step.
class InsideRanges final : public Observer {
 public:
  explicit InsideRanges(int laws) : reach_(static_cast<std::size_t>(laws)), range_(reach_.size()) {}
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler&, const EvaluatedState&) override {}
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override {
    for (std::size_t law = 0; law < reach_.size(); ++law) {
      reach_[law] = motion_->force_reach(static_cast<int>(law));
      range_[law] = motion_->force_range(static_cast<int>(law));
    }
    return false;
  }
  void step(const Assembler&, const EvaluatedState& from, const EvaluatedState& to) override {
    constexpr int kParts = 12;
    const double t_0 = from.state.t, h = to.state.t - t_0;
    for (std::size_t law = 0; law < reach_.size(); ++law) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int i = 1; i < kParts; ++i) {
        const double y = motion_->at(t_0 + h * i / kParts).at.responses[law].y;
        low = std::min(low, y);
        high = std::max(high, y);
      }
      largest = std::max({largest, -low, high});
      if (const auto& reach = reach_[law]) {
        ++reaches;
        beyond_reach = std::max({beyond_reach, reach->low - low, high - reach->high});
        widest = std::max(widest, reach->high - reach->low);
      }
      if (!range_[law]) continue;
      ++ranges;
      const StepMotion::Range& range = *range_[law];
      beyond_range = std::max({beyond_range, range.low - low - range.error, high - range.high - range.error});
      // At an end, which the places looked at are 1/12 away from, it may come further.
      const double first = from.responses[law].y, last = to.responses[law].y;
      short_of_range = std::max({short_of_range, std::min({low, first, last}) - range.low - range.error,
                                 range.high - std::max({high, first, last}) - range.error});
      note_bend(law, t_0, h, range);
    }
    ++steps;
  }
  int steps = 0, reaches = 0, ranges = 0;
  double largest = 0.0, beyond_reach = 0.0, widest = 0.0, beyond_range = 0.0, short_of_range = 0.0;  // N
  int bends = 0;
  double off_bend = 0.0;  // N

 private:
  /// The second derivative at a single turn, beside that of the parabola through three points about it.
  void note_bend(std::size_t law, double t_0, double h, const StepMotion::Range& range) {
    constexpr double kPart = 0.02;
    if (range.turns != 1 || range.turn < kPart || range.turn > 1.0 - kPart) return;
    const auto y = [&](double part) { return motion_->at(t_0 + h * part).at.responses[law].y; };
    const double before = y(range.turn - kPart), at = y(range.turn), behind = y(range.turn + kPart);
    off_bend = std::max(off_bend, std::abs((before - 2.0 * at + behind) / (kPart * kPart) - range.bend));
    ++bends;
  }
  StepMotion* motion_ = nullptr;
  std::vector<std::optional<StepMotion::Range>> reach_, range_;
};

}  // namespace

TEST_CASE("Exact propagation: a rebound from a flank whose damping grows with penetration") {
  // m v dv/dp = -p (k + g v): F(v) = v/g - k/g^2 ln(k + g v) is the same at both ends of the contact.
  const double k = 4e6, c = 300.0, p_ref = 1e-3, half_gap = 1e-4, speed = 0.8, mass = 2.0, g = c / p_ref;
  Model m = disc_on_mesh(
      mass, 0.0,
      {.stiffness = k, .normal_backlash = 2.0 * half_gap, .damping = c, .reference_penetration = p_ref});
  m.set_initial("disc", 0.0, speed);
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = 2.5e-3}, state);
  REQUIRE(run.ok());
  CHECK(run.contact_changes == 2);
  const auto f = [&](double v) { return v / g - k / (g * g) * std::log1p(g * v / k); };
  double low = -speed, high = 0.0;  // F falls below v = 0
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > f(speed) ? low : high) = middle;
  }
  CHECK(-low < 0.97 * speed);  // something is lost
  CHECK(state.v[0] == Approx(low).epsilon(1e-11));
  CHECK(run.energy.dissipated == Approx(0.5 * mass * (speed * speed - low * low)).epsilon(1e-9));
  CHECK(std::abs(run.energy.worst_imbalance) < 1e-11);
}

TEST_CASE("Exact propagation: a rebound from a flank that gets stiffer with its load") {
  // Harmonic motion on each stretch of the spring; the way back is the way there. k follows the phase, by nothing: the
  // angle of the given gear rests.
  const double k = 4e6, half_gap = 1e-4, speed = 0.5, mass = 2.0, p_1 = 1e-4, first = 0.8, second = 1.3;
  for (const MeshStiffness& stiffness : {MeshStiffness(k), MeshStiffness::table({0.0, 0.5}, {k, 2.0 * k})}) {
    Model m = disc_on_mesh(mass, 0.0,
                           {.teeth_1 = 1,
                            .teeth_2 = 1,
                            .stiffness = stiffness,
                            .normal_backlash = 2.0 * half_gap,
                            .stiffening = {{0.0, p_1}, {first, second}}});
    m.set_initial("disc", 0.0, speed);
    const System system = m.build();
    State state = State::initial(system);
    const double w_1 = std::sqrt(first * k / mass), w_2 = std::sqrt(second * k / mass);
    const double t_1 = std::asin(p_1 * w_1 / speed) / w_1, v_1 = speed * std::cos(w_1 * t_1);
    const double t_2 =
        std::atan2(v_1 * w_2, first / second * p_1 * w_2 * w_2) / w_2;  // from p_1 to the deepest place
    const double apart = half_gap / speed + 2.0 * (t_1 + t_2), end = apart + 1e-4;
    const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = end}, state);
    REQUIRE(run.ok());
    CHECK(run.contact_changes == 4);  // of stretches, too
    CHECK(state.v[0] == Approx(-speed).epsilon(1e-11));
    CHECK(std::abs(state.z[0] - (half_gap - speed * (end - apart))) < 1e-13);
    CHECK(std::abs(run.energy.worst_imbalance) < 1e-11);
  }
}

TEST_CASE("Exact propagation: a mesh whose stiffness rises linearly with the angle, by Bessel functions") {
  // x'' + (a + b t) x = 0, b > 0: x = sqrt(s) Z_1/3(2/3 s^(3/2)), s = b^(1/3) (t + a/b).
  const double mass = 0.5, speed = 4.0 * kPi, low = 2e5, high = 4e5, end = 0.2;  // of a mesh period of 0.5 s
  Model m = disc_on_mesh(
      mass, speed, {.teeth_1 = 1, .teeth_2 = 1, .stiffness = MeshStiffness::table({0.0, 0.8}, {low, high})});
  m.set_initial("disc", 1e-3, 0.0);
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = end}, state);
  REQUIRE(run.ok());
  const double a = low / mass, b = (high - low) / 0.8 * (speed / kTwoPi) / mass, root = std::cbrt(b);
  struct Pair {
    double value, slope;
  };
  const auto solution = [&](double t, bool second) {
    const double s = root * (t + a / b), z = 2.0 / 3.0 * std::pow(s, 1.5);
    const auto bessel = [&](double order) {
      return second ? std::cyl_neumann(order, z) : std::cyl_bessel_j(order, z);
    };
    // d/ds [sqrt(s) Z_1/3(z)] = -s Z_4/3(z) + sqrt(s)/(2 s) Z_1/3 + ...; by Z' = Z_1/3/(3 z) - Z_4/3, dz/ds = sqrt(s)
    const double value = std::sqrt(s) * bessel(1.0 / 3.0);
    const double slope =
        0.5 / std::sqrt(s) * bessel(1.0 / 3.0) + s * (bessel(1.0 / 3.0) / (3.0 * z) - bessel(4.0 / 3.0));
    return Pair{value, slope * root};
  };
  const Pair j_0 = solution(0.0, false), y_0 = solution(0.0, true);
  const Pair j = solution(end, false), y = solution(end, true);
  const double w = j_0.value * y_0.slope - y_0.value * j_0.slope, x_0 = 1e-3;
  const double of_j = x_0 * y_0.slope / w, of_y = -x_0 * j_0.slope / w;
  const double x = of_j * j.value + of_y * y.value, v = of_j * j.slope + of_y * y.slope;
  CHECK(std::abs(state.z[0] - x) < 1e-10 * x_0);
  CHECK(std::abs(state.v[0] - v) < 1e-10 * x_0 * std::sqrt(high / mass));
  CHECK(run.steps < 120);  // 25 periods of vibration, no passes
}

TEST_CASE("Exact propagation: a mesh of constant stiffness whose transmission error is zero on some teeth") {
  // Where the error is zero the mesh is a spring, which no one puts energy into; where it is not, its end does the work.
  const double inertia = 2.0, stiffness = 4e6, turned = 1e-5, rate = 0.3, t_end = 0.05;
  const auto run = [&](TransmissionError error) {
    Model m = disc_on_mesh(
        inertia, 20.0,
        {.teeth_1 = 10, .teeth_2 = 10, .stiffness = stiffness, .transmission_error = std::move(error)});
    m.set_initial("disc", turned, rate);
    const System system = m.build();
    State state = State::initial(system);
    const RunSummary summary = propagate(system, {.tolerance = 1e-11, .t_end = t_end}, state);
    INFO(summary.brief_report());
    CHECK(summary.ok());
    CHECK(std::abs(summary.energy.relative_error()) < 1e-10);
    return std::pair{summary, state};
  };
  const auto [none, state] = run(TransmissionError::table({0.0, 0.3}, {0.0, 0.0}));
  const double omega = std::sqrt(stiffness / inertia), phase = omega * t_end;
  CHECK(state.z[0] == Approx(turned * std::cos(phase) + rate / omega * std::sin(phase)).epsilon(1e-9));
  CHECK(std::abs(none.energy.input) < 1e-12);
  const auto [some, other] = run(TransmissionError::table({0.0, 0.3, 0.5, 0.8}, {0.0, 0.0, 1e-5, 0.0}));
  CHECK(std::abs(some.energy.input) > 1e-3);  // of 0.09 J at the start
}

TEST_CASE("Exact propagation: a limited damper behind a jump of its mesh's stiffness") {
  // A disc so heavy that it goes on at its speed v closes the gap at t_0; the flank then carries min(2 k p, k p + c v),
  // p = v (t - t_0), and loses k p or c v, whichever is less, by the stiffness of the moment.
  const double low = 1e6, high = 3e6, c = 2e4, half_gap = 1e-5, v = 0.05, end = 9e-3, jump = 7e-3;
  for (const bool rises : {true, false}) {
    const double first = rises ? low : high, second = rises ? high : low;
    Model m =
        disc_on_mesh(1e9, kTwoPi * 10.0,
                     {.teeth_1 = 10,
                      .teeth_2 = 10,
                      .stiffness = MeshStiffness::step(second, first, 1.7),  // at 0.7 of a period of 0.01 s
                      .normal_backlash = 2.0 * half_gap,
                      .damping = c,
                      .damping_law = MeshDamping::limited});
    m.set_initial("disc", 0.0, v);
    const System system = m.build();
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = end}, state);
    REQUIRE(run.ok());
    const auto lost = [&](double k, double from, double to) {
      const double a = v * from - half_gap, b = v * to - half_gap, knee = std::clamp(c * v / k, a, b);
      return 0.5 * k * (knee * knee - a * a) + c * v * (b - knee);
    };
    CHECK(run.energy.dissipated ==
          Approx(lost(first, half_gap / v, jump) + lost(second, jump, end)).epsilon(1e-6));
  }
}

namespace {

/// A gear at given speed drives a shaft of three discs, of which each has a cam with kinks; the first is the other gear.
Model cams_behind_mesh(GearMesh::Params mesh) {
  Model m("cams behind a mesh");
  for (const char* node : {"gear", "wheel", "middle", "end"}) m.add_node(node);
  mesh.base_radius_1 = 0.08;
  mesh.base_radius_2 = 0.16;
  mesh.teeth_1 = 20;
  mesh.teeth_2 = 40;
  mesh.normal_backlash = 5e-5;
  m.add<Inertia>("J_gear", {"gear"}, {.inertia = 0.02});
  m.add<GearMesh>("mesh", {"gear", "wheel"}, std::move(mesh));
  const double phases[] = {0.0, 0.4, 0.9};
  for (int i = 0; i < 3; ++i) {
    const std::string node = m.node_names()[static_cast<std::size_t>(i + 1)];
    m.add<Inertia>("J_" + node, {node}, {.inertia = 0.05});
    if (i > 0)
      m.add<ShaftSpring>("k_" + node, {m.node_names()[static_cast<std::size_t>(i)], node},
                         {.stiffness = 4e4});
    m.add<CamTorque>("cam_" + node, {node},
                     {.angle_table = PeriodicTable({0.0, 0.2, 0.3, 0.5, 0.7, 1.0},
                                                   {0.0, -60.0, 20.0, 35.0, 0.0, 0.0}, 1.2),
                      .phase = phases[i],
                      .twist_feedback = true});
  }
  m.add_node("drive");
  m.add<ShaftSpring>("k_gear", {"drive", "gear"}, {.stiffness = 3e4});
  m.constant_speed("drive", 120.0);
  return m;
}

}  // namespace

TEST_CASE("Exact propagation: mesh stiffness by phase and kinks of tables share a sweep", "[once]") {
  const double k = 3e7;
  const MeshStiffness constant(k),
      fourier = MeshStiffness::fourier_of_step(0.7 * k, 1.2 * k, 1.6, 4),
      table = MeshStiffness::table({0.0, 0.3, 0.5, 0.8}, {k, 1.3 * k, 0.8 * k, 0.9 * k}),
      step = MeshStiffness::step(0.8 * k, 1.2 * k, 1.6);
  const std::pair<double, MeshDamping> dampings[] = {
      {0.0, MeshDamping::proportional}, {3e3, MeshDamping::proportional}, {3e3, MeshDamping::limited}};
  for (const auto& [damping, law] : dampings)
    for (const MeshStiffness* stiffness : {&constant, &fourier, &table, &step}) {
      const System system =
          cams_behind_mesh({.stiffness = *stiffness, .damping = damping, .damping_law = law}).build();
      State exact = State::initial(system), other = exact;
      const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = 0.05}, exact);
      const RunSummary known =
          run_method(system, {.name = "dormand_prince", .tolerance = 1e-13}, {.t_end = 0.05}, other);
      INFO(run.brief_report());
      REQUIRE(run.ok());
      REQUIRE(known.ok());
      INFO("damping " << damping << ": " << run.steps << " steps, " << run.contact_changes << " changes");
      CHECK(run.contact_changes > 40);
      // Some fifty impacts magnify what each step leaves.
      CHECK((exact.z - other.z).lpNorm<Eigen::Infinity>() < 1e-9 * other.z.lpNorm<Eigen::Infinity>());
      CHECK((exact.v - other.v).lpNorm<Eigen::Infinity>() < 5e-9 * other.v.lpNorm<Eigen::Infinity>());
      CHECK(std::abs(run.energy.relative_error()) < 1e-8);
      // Passes took 71 to 75.
      if (stiffness == &fourier)
        CHECK(static_cast<double>(run.solves) < 65.0 * static_cast<double>(run.steps));
    }
}

TEST_CASE("Exact propagation: laws of a mesh take little more steps than a spring does") {
  // Ratio to constant stiffness: a jump of the stiffness, or a table's point, ends a step.
  const std::pair<const char*, double> most[] = {
      {"stiffness in steps", 1.1},   {"Fourier", 1.06},        {"table", 1.35},
      {"proportional damping", 1.1}, {"limited damping", 1.1}, {"damping, stiffness in steps", 1.2}};
  const auto steps = [](const char* law) {
    const System system = test::gear_drive_with(test::mesh_law(law)).system;
    const RunSummary run = propagate(system, {.tolerance = 1e-8, .t_end = 0.1});
    REQUIRE(run.ok());
    return static_cast<double>(run.steps);
  };
  const double constant = steps("constant stiffness");
  for (const auto& [law, ratio] : most) {
    CAPTURE(law);
    CHECK(steps(law) <= ratio * constant);
  }
}

TEST_CASE("Exact propagation: the ranges of forces inside steps hold what they are there") {
  for (const test::MeshLaw& law : test::mesh_laws()) {
    CAPTURE(law.name);
    const System system = test::gear_drive_with(law).system;
    InsideRanges inside(static_cast<int>(system.scalars().size()));
    REQUIRE(propagate(system, {.tolerance = 1e-8, .t_end = 0.05}, {&inside}).ok());
    CHECK(inside.largest > 1e3);
    CHECK(inside.ranges == 2 * inside.steps);  // of two meshes
    CHECK(inside.beyond_range < 1e-5 * inside.largest);
    // Between two of the places, 1/12 of the step apart.
    CHECK(inside.short_of_range < 0.01 * inside.largest);
    CHECK(inside.bends > 20);
    CHECK(inside.off_bend < 1e-4 * inside.largest);
    CHECK(inside.beyond_reach < 1e-9 * inside.largest);
    CHECK(inside.widest < inside.largest);
    const std::string name = law.name;
    const bool damped =
        name.find(" damping") != std::string::npos && name.find("no damping") == std::string::npos;
    if (!damped && name.find("Fourier") == std::string::npos) CHECK(inside.reaches > inside.steps);
  }
}

TEST_CASE("Exact propagation: steps go over knots of the stiffness of teeth that are apart") {
  // A disc that turns on its own with its gear, inside the backlash: 60 teeth of 2 knots each a revolution.
  Model m = disc_on_mesh(2.0, 20.0,
                         {.teeth_1 = 60,
                          .teeth_2 = 60,
                          .stiffness = MeshStiffness::step(3e3, 5e3, 1.5),
                          .normal_backlash = 2e-4});
  m.set_initial("disc", 0.0, 5e-5);
  const System system = m.build();
  const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = 1.0});
  INFO(run.brief_report());
  REQUIRE(run.ok());
  CHECK(run.contact_changes == 0);
  const double knots = 2.0 * 60.0 * 20.0 / kTwoPi;
  CHECK(static_cast<double>(run.steps) < 0.5 * knots);
}
