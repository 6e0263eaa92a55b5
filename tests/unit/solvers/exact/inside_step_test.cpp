// Exact propagation inside its steps: histories and peaks where loads have kinks, laws switch, and flanks
// meet for a short time; the steps that kinks and harmonics in one model cost.
// Covers solvers/exact/step_expansion.hpp and solvers/run/observer.hpp through propagate().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "tests/catch.hpp"
#include "tests/problems/mesh_laws.hpp"

using namespace drev;

namespace {

constexpr double kJ = 0.05, kShaft = 1e5, kSpeed = 3000.0 * kPi / 30.0;
constexpr std::array<double, 6> kAngles{0, 20, 40, 60, 80, 360}, kTorques{0, 400, 400, -300, 0, 0};

Model cam_on_a_shaft() {
  Model m("cam on a shaft");
  for (const char* node : {"drive", "disc"}) m.add_node(node);
  m.constant_speed("drive", kSpeed);
  m.add<Inertia>("J", {"disc"}, {.inertia = kJ});
  m.add<ShaftSpring>("shaft", {"drive", "disc"}, {.stiffness = kShaft});
  std::vector<double> angles(kAngles.begin(), kAngles.end() - 1);
  for (double& a : angles) a *= kPi / 180.0;
  m.add<CamTorque>("cam", {"disc"},
                   {.angle_table = PeriodicTable(angles, {kTorques.begin(), kTorques.end() - 1}),
                    .twist_feedback = false});
  return m;
}

/// J q'' + k q = T, T straight between the table's points: q in closed form, straight by straight.
struct ClosedForm {
  static constexpr double w = 1414.2135623730950488;  // sqrt(k/J)
  struct Piece {
    double begin, f, slope, a, b;
    double q(double t) const {
      const double s = t - begin;
      return (f + slope * s) / kShaft + a * std::cos(w * s) + b * std::sin(w * s);
    }
    double v(double t) const {
      const double s = t - begin;
      return slope / kShaft - a * w * std::sin(w * s) + b * w * std::cos(w * s);
    }
  };
  std::vector<Piece> pieces;

  explicit ClosedForm(double end) {
    double q = 0.0, v = 0.0;
    for (int turn = 0;; ++turn)
      for (std::size_t i = 0; i < 5; ++i) {
        const auto time = [&](double deg) { return (deg * kPi / 180.0 + kTwoPi * turn) / kSpeed; };
        const double begin = time(kAngles[i]), length = time(kAngles[i + 1]) - begin;
        if (begin >= end) return;
        const double slope = (kTorques[i + 1] - kTorques[i]) / length;
        pieces.push_back({begin, kTorques[i], slope, q - kTorques[i] / kShaft, (v - slope / kShaft) / w});
        q = pieces.back().q(begin + length);
        v = pieces.back().v(begin + length);
      }
  }
  const Piece& at(double t) const {
    std::size_t i = pieces.size() - 1;
    while (pieces[i].begin > t) --i;
    return pieces[i];
  }
  /// Largest |q| at a turn of q, by halving between samples.
  double peak(double end) const {
    double most = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      double low = end * i / n, high = end * (i + 1) / n;
      const double v_low = at(low).v(low);
      if (v_low * at(high).v(high) > 0.0) continue;
      for (int half = 0; half < 60; ++half) {
        const double middle = 0.5 * (low + high);
        (at(middle).v(middle) * v_low > 0.0 ? low : high) = middle;
      }
      most = std::max(most, std::abs(at(low).q(low)));
    }
    return most;
  }
};

}  // namespace

TEST_CASE("A cam of five points at the nominal angle: the motion inside steps and its peak in closed form") {
  constexpr double kEnd = 0.1;
  const System system = cam_on_a_shaft().build();
  const ClosedForm truth(kEnd);
  const double peak = kShaft * truth.peak(kEnd);
  CHECK(peak == Approx(1032.837164206).epsilon(1e-11));
  for (const double tolerance : {1e-8, 1e-12}) {
    Recorder history(system, {"disc.angle_rad", "disc.speed_rad_per_s"}, 1.7e-4);
    Peaks peaks(find_channels(system, {"shaft.torque_Nm", "disc.acceleration_rad_per_s2"}));
    CHECK(propagate(system, {.tolerance = tolerance, .t_end = kEnd}, {&history, &peaks}).ok());
    CHECK(peaks.peaks()[0].amplitude() == Approx(peak).epsilon(tolerance));
    for (std::size_t i = 0; i < history.times().size(); ++i) {
      const double t = history.times()[i];
      INFO(t);
      CHECK(std::abs(history.samples(0)[i] - truth.at(t).q(t)) <= 4 * tolerance * peak / kShaft);
      CHECK(std::abs(history.samples(1)[i] - truth.at(t).v(t)) <=
            4 * tolerance * ClosedForm::w * peak / kShaft);
    }
  }
}

TEST_CASE("Peaks of what has no rate: torque of an ideal gear, acceleration, load, reaction") {
  constexpr double kA = 10.0, kF = 5.0, kJ1 = 0.1, kJ2 = 2.0, kRatio = 0.1;
  Model m("motor and gear");
  for (const char* node : {"motor", "load"}) m.add_node(node);
  m.add<Inertia>("J1", {"motor"}, {.inertia = kJ1});
  m.add<IdealGear>("gear", {"motor", "load"}, {.ratio = kRatio});
  m.add<Inertia>("J2", {"load"}, {.inertia = kJ2});
  m.add<AppliedTorque>("sine", {"motor"}, {.harmonics = {{kF, kA, -kPi / 2}}});
  const System system = m.build();
  Peaks peaks(find_channels(system, {"gear.torque_Nm", "motor.acceleration_rad_per_s2", "sine.torque_Nm"}));
  CHECK(propagate(system, {.t_end = 0.17}, {&peaks}).ok());
  // omega_2 = ratio omega_1: the motor feels J1 + ratio^2 J2.
  const double acceleration = kA / (kJ1 + kRatio * kRatio * kJ2);
  CHECK(peaks.peaks()[0].amplitude() == Approx(kJ2 * kRatio * acceleration).epsilon(1e-12));
  CHECK(peaks.peaks()[1].amplitude() == Approx(acceleration).epsilon(1e-12));
  CHECK(peaks.peaks()[1].max_time == Approx(0.05).epsilon(1e-5));
  CHECK(peaks.peaks()[2].amplitude() == Approx(kA).epsilon(1e-12));
}

TEST_CASE("A load's peak lies at the knot of its table, on free and on prescribed nodes") {
  for (const bool prescribed : {false, true}) {
    Model m = cam_on_a_shaft();
    m.add<CamTorque>("sharp", {prescribed ? "drive" : "disc"},
                     {.angle_table = PeriodicTable({0.0, 1.0, 1.013, 1.03}, {0.0, 0.0, 371.0, 0.0}),
                      .twist_feedback = !prescribed});
    const System system = m.build();
    Peaks peaks(find_channels(system, {"sharp.torque_Nm"}));
    CHECK(propagate(system, {.t_end = 0.1}, {&peaks}).ok());
    CHECK(peaks.peaks()[0].amplitude() == Approx(371.0).epsilon(1e-9));
  }
}

TEST_CASE("Contacts of any duration are counted, and the largest force has the same digits everywhere") {
  // A mass thrown to and fro between two walls, in contact with each for one step: m v sqrt(k/m) at most.
  Model m("short contacts");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<PolylineSpring>("walls", {"m"}, PolylineSpring::dead_band(1e8, 1.0));
  m.set_initial("m", 0.0, 1.0);
  const System system = m.build();
  ContactStatistics contacts(system);
  Peaks peaks(find_channels(system, {"walls.force_N"}));
  long changes = 0;
  const ExactOptions options{.t_end = 8.5, .on_change = [&](const ContactChange&) { ++changes; }};
  CHECK(propagate(system, options, {&contacts, &peaks}).ok());
  const ContactRecord& record = contacts.records().front();
  CHECK(changes == 2 * record.impacts());
  CHECK(record.impacts() == 4);
  CHECK(record.largest_force == peaks.peaks()[0].amplitude());
  CHECK(record.largest_force == Approx(1e4).epsilon(1e-9));
  CHECK(record.front_force.mean() == Approx(1e4).epsilon(1e-9));
  CHECK(record.back_force.mean() == Approx(1e4).epsilon(1e-9));
}

TEST_CASE("Each of contacts that grow weaker has its own largest force, those of a single step included") {
  // A mass between two walls; a spring pulls it to the middle, so that it is on a wall for less than half a period. Behind the
  // edge m d'' = - (k + g) d - g, with the rate v there: d = (sqrt(g^2 + (k + g) m v^2) - g)/(k + g) at most.
  const double k = 1e8, g = 1e4;  // N/m; the walls are 1 m from the middle
  Model m("weaker contacts");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<GroundSpring>("pull", {"m"}, {.stiffness = g, .damping = 3e-4});
  m.add<PolylineSpring>("walls", {"m"}, PolylineSpring::dead_band(k, 1.0));
  m.set_initial("m", 0.0, std::sqrt(g + 1.0));
  const System system = m.build();
  ContactStatistics contacts(system);
  ContactEvents events(system);
  REQUIRE(propagate(system, {.tolerance = 1e-10, .t_end = 0.25}, {&contacts, &events}).ok());
  for (const bool front : {true, false}) {
    std::vector<double> largest;
    for (const ContactEvent& e : events.all()) {
      if (!e.made || e.front != front) continue;
      largest.push_back(k * (std::sqrt(g * g + (k + g) * e.rate * e.rate) - g) / (k + g));
      if (largest.size() > 1) CHECK(largest.back() < largest[largest.size() - 2]);
    }
    CHECK(largest.size() >= 3);
    const Distribution& found = front ? contacts.records()[0].front_force : contacts.records()[0].back_force;
    REQUIRE(found.count() == static_cast<long>(largest.size()));
    const double sum = std::accumulate(largest.begin(), largest.end(), 0.0);
    CHECK(found.mean() == Approx(sum / static_cast<double>(largest.size())).epsilon(1e-4));
  }
}

TEST_CASE("A table and harmonics in one model cost no more steps than the dearer of them") {
  const auto steps = [](bool table, bool harmonic) {
    Model m("two discs");
    for (const char* node : {"grid", "crank", "rotor"}) m.add_node(node);
    m.constant_speed("grid", kSpeed / 2);
    m.add<Inertia>("J1", {"crank"}, {.inertia = 1.0});
    m.add<Inertia>("J2", {"rotor"}, {.inertia = 3.0});
    m.add<ShaftSpring>("s", {"crank", "rotor"}, {.stiffness = 2e5});
    m.add<ShaftSpring>("soft", {"rotor", "grid"}, {.stiffness = 1e3});
    std::vector<double> angles, torques;
    for (int i = 0; i < 72; ++i) {
      angles.push_back(kTwoPi * i / 72);
      torques.push_back(500.0 * std::exp(-0.1 * i) * std::sin(angles.back()));
    }
    if (table) m.add<CamTorque>("gas", {"crank"}, {.angle_table = PeriodicTable(angles, torques)});
    if (harmonic)
      m.add<EngineOrderTorque>("mass", {"crank"}, {.harmonics = {{2.0, 300.0, 0.3}, {4.0, 50.0, 1.0}}});
    return propagate(m.build(), {.t_end = 0.2}).steps;
  };
  const long one = steps(true, false), other = steps(false, true);
  CHECK(steps(true, true) < 2 * std::max(one, other));
}

namespace {

/// The mean of the largest force of every contact on a flank, from the motion each microsecond.
class Sampled final : public Observer {
 public:
  explicit Sampled(const System& system) : system_(system) {
    for (std::size_t j = 0; j < system.scalars().size(); ++j)
      if (system.scalars()[j].force->gap()) contacts.push_back({.law = j});
  }
  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override {
    for (Contact& c : contacts) {
      const Gap gap = *system_.scalars()[c.law].force->gap();
      const double x = to.inputs[c.law].x, y = std::abs(to.responses[c.law].y);
      const int side = x > gap.high ? 1 : x < gap.low ? -1 : 0;
      if (side != c.side) {
        if (c.side != 0 && c.begun) (c.side > 0 ? c.front : c.back).push_back(c.largest);
        c.begun = true;
        c.side = side;
        c.largest = 0.0;
      }
      c.largest = std::max(c.largest, y);
    }
  }
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override { return false; }
  double next_stop(double t) const override { return t + 1e-6; }

  struct Contact {
    std::size_t law = 0;
    int side = 0;
    bool begun = false;
    double largest = 0.0;
    std::vector<double> front = {}, back = {};
  };
  std::vector<Contact> contacts;

 private:
  const System& system_;
};

/// Counts what an observer is shown; `inside`: of each step points inside, whether it asks for them or not.
class Shown final : public Observer {
 public:
  Shown(Observer& shown, bool inside) : shown_(shown), inside_(inside) {}
  void look_through(StepMotion& motion) override { shown_.look_through(motion); }
  void start(const Assembler& assembler, const EvaluatedState& point) override {
    shown_.start(assembler, point);
  }
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override {
    ++count;
    shown_.step(assembler, from, to);
  }
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    shown_.restart(assembler, point);
  }
  bool needs_acceleration() const override { return shown_.needs_acceleration(); }
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override {
    return inside_ || shown_.looks_inside(from, to, beyond_cubic);
  }
  long count = 0;

 private:
  Observer& shown_;
  bool inside_;
};

}  // namespace

TEST_CASE("Steps are shown whole where no peak passes inside: the same peaks and contacts from fewer points",
          "[once]") {
  struct Watched {
    std::vector<Peak> peaks;
    std::vector<ContactRecord> contacts;
    long shown = 0, steps = 0;
  };
  const auto check = [](const System& system, std::vector<std::string> channels, double t_end) {
    for (const Channel& c : all_channels(system))
      if (c.force_of() >= 0) channels.push_back(c.name());
    const auto watch = [&](bool inside) {
      Peaks peaks(find_channels(system, channels));
      ContactStatistics contacts(system);
      Shown of_peaks(peaks, inside), of_contacts(contacts, inside);
      const RunSummary run =
          propagate(system, {.tolerance = 1e-10, .t_end = t_end}, {&of_peaks, &of_contacts});
      REQUIRE(run.ok());
      return Watched{peaks.peaks(), contacts.records(), of_peaks.count, run.steps};
    };
    const Watched few = watch(false), all = watch(true);
    CHECK(all.shown > 8 * all.steps);
    CHECK(4 * few.shown < all.shown);
    for (std::size_t c = 0; c < all.peaks.size(); ++c) {
      CAPTURE(channels[c]);
      CHECK(few.peaks[c].max == Approx(all.peaks[c].max).epsilon(1e-9));
      CHECK(few.peaks[c].min == Approx(all.peaks[c].min).epsilon(1e-9));
    }
    for (std::size_t i = 0; i < all.contacts.size(); ++i) {
      const ContactRecord &a = few.contacts[i], &b = all.contacts[i];
      CHECK(a.front_impacts == b.front_impacts);
      CHECK(a.back_impacts == b.back_impacts);
      CHECK(a.largest_force == Approx(b.largest_force).epsilon(1e-9));
      CHECK(a.time_separated == Approx(b.time_separated).epsilon(1e-9));
      CHECK(a.front_force.mean() == Approx(b.front_force.mean()).epsilon(1e-4));
      CHECK(a.back_force.mean() == Approx(b.back_force.mean()).epsilon(1e-4));
      CHECK(a.impact_energy == Approx(b.impact_energy).epsilon(1e-9));
    }
  };
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("drive", "gears");
  const ModelCase camshaft = camshaft_entry().build(parameters);  // with Rayleigh damping
  check(camshaft.model.build(), camshaft.torques, 0.2);
  for (const test::MeshLaw& law : test::mesh_laws()) {
    CAPTURE(law.name);
    const test::GearDrive drive = test::gear_drive_with(law);
    check(drive.system, drive.torques, 0.15);
  }
}

/// Looks at the motion inside steps alone.
class InsideSteps : public Observer {
 public:
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState&) override {}

 protected:
  StepMotion* motion_ = nullptr;
};

/// Compares speeds in the middle of steps with the cubic through both ends and its bound.
class OfSpeeds final : public InsideSteps {
 public:
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to, const double* beyond) override {
    const double h = to.state.t - from.state.t;
    const EvaluatedState& middle = motion_->at(0.5 * (from.state.t + to.state.t)).at;
    const Vector cubic = 0.5 * (from.state.v + to.state.v) + h / 8.0 * (from.state.a - to.state.a);
    for (Eigen::Index i = 0, n = cubic.size(); i < n; ++i)
      CHECK(std::abs(middle.state.v[i] - cubic[i]) <= beyond[n + i] + 1e-10 * std::abs(cubic[i]));
    unbounded += std::isinf(beyond[cubic.size()]) ? 1 : 0;
    return false;
  }
  int unbounded = 0;
};

TEST_CASE("Speeds stay within their bound of a cubic, where accelerations jump with a stiffness as well") {
  Model m("mesh under load");
  for (const char* node : {"pinion", "wheel"}) m.add_node(node);
  m.constant_speed("pinion", 3.0);
  m.add<Inertia>("J", {"wheel"}, {.inertia = 0.2});
  m.add<AppliedTorque>("load", {"wheel"}, {.table = TimeTable({0.0, 1.0}, {100.0, 100.0})});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.1,
                   .teeth_1 = 20,
                   .stiffness = MeshStiffness::step(0.7e6, 1.3e6, 1.5)});
  OfSpeeds speeds;
  const RunSummary run = propagate(m.build(), {.t_end = 0.2}, {&speeds});
  CHECK(run.ok());
  // 3 rad/s over 20 teeth: 1.9 mesh periods with two jumps, beside each of which are two steps.
  CHECK(speeds.unbounded >= 6);
  CHECK(2 * speeds.unbounded < run.steps);
}

/// Compares the ranges of A cos(w t) + c v in the steps with their closed form.
class OfOscillation final : public InsideSteps {
 public:
  static constexpr double kA = 0.01, kW = 200.0, kC = 3e-3;
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to, const double*) override {
    const auto range = motion_->range({{0, 2.0}}, {{0, kC}});
    REQUIRE(range);
    // 2 cos(w t) - w c sin(w t) = r cos(w t + lag).
    const double r = kA * std::hypot(2.0, kW * kC), lag = std::atan2(kW * kC, 2.0);
    const double begin = kW * from.state.t + lag, end = kW * to.state.t + lag;
    const double a = r * std::cos(begin), b = r * std::cos(end);
    double high = std::max(a, b), low = std::min(a, b), last = 0.0;
    int turns = 0;
    for (double k = std::ceil(begin / kPi); k * kPi < end; ++k, ++turns) {
      last = k * kPi;
      high = std::max(high, r * std::cos(last));
      low = std::min(low, r * std::cos(last));
    }
    CHECK(range->high == Approx(high).margin(1e-9 * r));
    CHECK(range->low == Approx(low).margin(1e-9 * r));
    CHECK(range->error == 0.0);
    CHECK(range->turns == turns);
    if (turns == 0) return false;
    CHECK(range->turn == Approx((last - begin) / (end - begin)).margin(1e-3));
    CHECK(range->bend == Approx(-r * std::cos(last) * (end - begin) * (end - begin)).epsilon(1e-3));
    count += turns;
    twice += turns == 2;
    return false;
  }
  int count = 0, twice = 0;
};

TEST_CASE("The range of a row inside steps, and where it turns, in closed form") {
  Model m("oscillator");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 0.5});
  m.add<GroundSpring>("k", {"disc"}, {.stiffness = 0.5 * OfOscillation::kW * OfOscillation::kW});
  const System system = m.build();
  State state = State::initial(system);
  state.z[0] = OfOscillation::kA;
  OfOscillation ranges;
  CHECK(propagate(system, {.tolerance = 1e-12, .t_end = 1.0}, state, {&ranges}).ok());
  CHECK(ranges.count >= 63);  // 200 rad over pi
  CHECK(ranges.twice > 0);
}

/// Compares the mean of the largest forces of all contacts with that of the motion each microsecond.
void check_contacts(const System& system, const ExactOptions& options, double within) {
  ContactStatistics contacts(system);
  Sampled sampled(system);
  REQUIRE(propagate(system, options, {&contacts}).ok());
  REQUIRE(propagate(system, options, {&sampled}).ok());
  for (std::size_t i = 0; i < sampled.contacts.size(); ++i) {
    const auto check = [&](const Distribution& found, const std::vector<double>& expected) {
      REQUIRE(found.count() == static_cast<long>(expected.size()));
      if (expected.empty()) return;
      const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
      CHECK(found.mean() == Approx(sum / static_cast<double>(expected.size())).epsilon(within));
    };
    check(contacts.records()[i].front_force, sampled.contacts[i].front);
    check(contacts.records()[i].back_force, sampled.contacts[i].back);
  }
}

TEST_CASE("The largest force of each contact is that of the motion sampled every microsecond", "[once]") {
  std::vector<test::MeshLaw> laws = test::mesh_laws();
  laws.push_back({"Fourier series and a transmission error", [](GearMesh::Params& p) {
                    test::mesh_law("Fourier").change(p);
                    p.transmission_error = TransmissionError::table({0.0, 0.3, 0.6, 0.8}, {0, 0, 2e-6, 0});
                  }});
  for (const test::MeshLaw& law : laws) {
    CAPTURE(law.name);
    const System system = test::gear_drive_with(law).system;
    const ExactOptions options{.tolerance = 1e-10, .t_end = 0.02};
    // A force that is largest just before the stiffness jumps lies between two samples.
    const double within = std::string(law.name).find("steps") != std::string::npos ? 1e-3 : 1e-4;
    check_contacts(system, options, within);
  }
}

TEST_CASE("The largest force of each contact beside cams on both gears, with damping and varying stiffness") {
  for (const double speed : {70.0, 110.0, 150.0})
    for (const MeshDamping damping : {MeshDamping::proportional, MeshDamping::limited})
      for (const bool stiffening : {false, true}) {
        CAPTURE(speed, damping == MeshDamping::limited, stiffening);
        Model m("cams beside a mesh");
        for (const char* node : {"drive", "pinion", "wheel"}) m.add_node(node);
        m.constant_speed("drive", speed);
        m.add<ShaftSpring>("shaft", {"drive", "pinion"}, {.stiffness = 3e4});
        GearMesh::Params mesh{.base_radius_1 = 0.08, .base_radius_2 = 0.16, .teeth_1 = 20, .teeth_2 = 40};
        mesh.normal_backlash = 5e-5;
        mesh.damping = 1500.0;
        mesh.damping_law = damping;
        mesh.stiffness = MeshStiffness::fourier_of_step(1e7, 1.8e7, 1.6, 4);
        if (stiffening) {
          mesh.stiffness = 1.4e7;
          mesh.stiffening = {{0.0, 2e-5}, {0.8, 1.3}};
          mesh.reference_penetration = 5e-6;
        }
        m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh);
        for (const char* node : {"pinion", "wheel"}) {
          m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 0.05});
          m.add<CamTorque>(std::string("cam_") + node, {node},
                           {.angle_table = PeriodicTable({0.0, 0.2, 0.3, 0.5, 0.7, 1.0},
                                                         {0.0, -60.0, 20.0, 35.0, 0.0, 0.0}, 1.2)});
        }
        check_contacts(m.build(), {.tolerance = 1e-10, .t_end = 0.04}, 5e-5);
      }
}
