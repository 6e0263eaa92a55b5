#include "tests/stability/coverage/random_spec.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace coverage {

namespace {

constexpr double kTwoPi = 6.283185307179586;

/// The same numbers with every standard library: the engine is specified, its distributions are not.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) { engine_.discard(64); }
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double logarithmic(double low, double high) { return low * std::pow(high / low, (*this)(0.0, 1.0)); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned long>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  double phase() { return (*this)(0.0, kTwoPi); }

 private:
  std::mt19937_64 engine_;
};

/// What a family may hold.
struct Traits {
  const char* name;
  bool gaps = false;         ///< backlash, dead bands, stops
  bool damped_gaps = false;  ///< every damping law
  bool errors = false;       ///< transmission errors
  bool varying = false;      ///< stiffness over the phase
  bool feedback = false;     ///< loads over the actual angle
  bool run_up = false;
  bool lively = false;  ///< little damping and much excitation: often chaotic
};

constexpr Traits kFamilies[] = {
    {.name = "linear"},
    {.name = "linear"},
    {.name = "backlash", .gaps = true, .damped_gaps = true},
    {.name = "backlash", .gaps = true, .damped_gaps = true, .run_up = true},
    {.name = "backlash with transmission error", .gaps = true, .damped_gaps = true, .errors = true},
    {.name = "rattle", .gaps = true, .damped_gaps = true, .lively = true},
    {.name = "backlash with varying stiffness", .gaps = true, .damped_gaps = true, .varying = true},
    {.name = "varying stiffness and feedback", .errors = true, .varying = true, .feedback = true},
    {.name = "feedback", .errors = true, .feedback = true, .run_up = true},
    {.name = "everything",
     .gaps = true,
     .damped_gaps = true,
     .errors = true,
     .varying = true,
     .feedback = true,
     .run_up = true},
};

class Maker {
 public:
  Maker(unsigned seed, const Traits& traits, bool periodic)
      : dice_(seed), traits_(traits), periodic_(periodic) {
    spec_.name = std::string(periodic ? "periodic " : "random ") + std::to_string(seed);
    spec_.family = traits.name;
  }

  Spec make() {
    const int nodes = dice_.one_in(4) ? 2 + dice_.below(11) : 2 + dice_.below(5);
    speed_ = dice_(40.0, 400.0);
    turns_ = periodic_ || traits_.run_up || traits_.varying || traits_.errors || !dice_.one_in(3);
    if (traits_.errors && dice_.one_in(5) && !periodic_) turns_ = false;  // an error that stands still
    torque_ = dice_.logarithmic(10.0, 300.0);
    add_node();
    for (int i = 1; i < nodes; ++i) attach(i);
    hold();
    add_loads();
    add_damping();
    set_initial();
    set_times();
    return spec_;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  int count() const { return static_cast<int>(spec_.nodes.size()); }

  void add_node() {
    spec_.nodes.push_back({.inertia = dice_.logarithmic(0.005, 0.3)});
    kinematic_.push_back(1.0);
  }

  /// Node i hangs on an earlier one, by a shaft, a mesh, an ideal gear or a coupling.
  void attach(int i) {
    add_node();
    const int to = dice_.one_in(3) ? dice_.below(i) : i - 1;
    const bool must = i == 1 && (traits_.gaps || traits_.varying || traits_.errors);
    const int kind = must ? 5 : dice_.below(10);
    if (kind <= 4) {
      spec_.shafts.push_back({to, i, dice_.logarithmic(5e3, 4e5), dice_.one_in(2) ? dice_(0.0, 2.0) : 0.0});
      kinematic_[at(i)] = kinematic_[at(to)];
    } else if (kind <= 7) {
      add_mesh(to, i);
    } else if (kind == 8) {
      const double ratio = dice_.logarithmic(0.3, 3.0) * (dice_.one_in(2) ? -1.0 : 1.0);
      spec_.gears.push_back({to, i, ratio});
      kinematic_[at(i)] = ratio * kinematic_[at(to)];
    } else {
      add_coupling(to, i);
    }
  }

  void add_coupling(int to, int i) {
    kinematic_[at(i)] = kinematic_[at(to)];
    const double k = dice_.logarithmic(5e3, 2e5), x = torque_ / k * dice_(0.3, 1.5);
    Polyline p{.a = to, .b = i, .damping = dice_(0.0, 0.5)};
    if (!traits_.gaps) {
      spec_.shafts.push_back({to, i, k, 0.0});
      return;
    }
    if (dice_.one_in(2)) {
      p.x = {-2 * x, -x, 1.1 * x, 2 * x};
      p.y = {-k * x, 0.0, 0.0, k * 0.9 * x};
    } else {
      p.x = {-3 * x, -x, 1.2 * x, 2 * x};
      p.y = {-8 * k * x, -k * x, 1.2 * k * x, 4.5 * k * x};
    }
    spec_.polylines.push_back(p);
  }

  void add_mesh(int a, int b) {
    Mesh m{.a = a, .b = b};
    const int teeth_a = 17 + dice_.below(30), teeth_b = 17 + dice_.below(60);
    const double module = dice_(0.0015, 0.004);
    m.internal = teeth_b > teeth_a + 10 && dice_.one_in(5);
    m.radius_a = module * teeth_a * 0.47;
    m.radius_b = m.radius_a * teeth_b / teeth_a;
    m.teeth = teeth_a;
    m.phase = dice_(0.0, 1.0);
    kinematic_[at(b)] = (m.internal ? 1.0 : -1.0) * m.radius_a / m.radius_b * kinematic_[at(a)];
    m.stiffness = dice_.logarithmic(2e7, 3e8);
    if (traits_.gaps && (spec_.meshes.empty() || !dice_.one_in(3)))
      m.backlash = dice_.logarithmic(1e-5, 2e-4);
    const double mass = 1.0 / (m.radius_a * m.radius_a / spec_.nodes[at(a)].inertia +
                               m.radius_b * m.radius_b / spec_.nodes[at(b)].inertia);
    const double critical = 2.0 * std::sqrt(m.stiffness * mass);
    if (!dice_.one_in(4) || periodic_)
      m.damping = critical * (traits_.lively ? dice_(0.002, 0.02) : dice_(0.02, 0.12));
    m.law = static_cast<Law>(dice_.below(4));
    if (dice_.one_in(3) && m.backlash > 0.0)
      m.reference_penetration = m.backlash * dice_.logarithmic(0.01, 0.3);
    if (traits_.varying) vary(m);
    if (traits_.errors && (spec_.meshes.empty() || dice_.one_in(2))) {
      const double size = dice_.logarithmic(5e-7, 8e-6);
      if (dice_.one_in(3))
        m.error_table = {{0.05, 0.3, 0.7}, {-size, size * dice_(0.2, 1.0), size * dice_(-1.0, 0.5)}, 1.0};
      else
        m.error_harmonics = {{1.0, size, dice_.phase()}, {2.0, 0.3 * size, dice_.phase()}};
    }
    spec_.meshes.push_back(m);
  }

  void vary(Mesh& m) {
    const int kind = dice_.below(3);
    if (kind == 0) {
      m.kind = Mesh::Stiffness::step;
      m.both = m.stiffness * dice_(1.2, 1.8);
      m.ratio = dice_(1.2, 1.8);
    } else if (kind == 1) {
      m.kind = Mesh::Stiffness::fourier;
      m.stiffness_harmonics = {{1.0, m.stiffness * dice_(0.05, 0.25), dice_.phase()},
                               {2.0, m.stiffness * dice_(0.02, 0.1), dice_.phase()}};
    } else {
      m.kind = Mesh::Stiffness::table;
      const double k = m.stiffness;
      m.stiffness_table = {
          {0.1, 0.35, 0.6, 0.8}, {k, k * dice_(1.1, 1.5), k * dice_(1.0, 1.6), k * dice_(0.8, 1.0)}, 1.0};
    }
  }

  /// What carries the mean torque, or the nominal motion.
  void hold() {
    if (turns_) {
      spec_.nominal = {.node = 0, .omega_0 = speed_, .omega_1 = speed_};
      spec_.nodes[0].prescribed = periodic_ || dice_.one_in(2);
    } else if (dice_.one_in(2)) {
      spec_.nodes[0].prescribed = true;
    } else if (dice_.one_in(2)) {
      spec_.springs.push_back({0, -1, dice_.logarithmic(2e3, 1e5), dice_(0.0, 2.0)});
    }
  }

  void add_loads() {
    const int last = count() - 1;
    // A mean torque in at node 0 and out at the last: their powers cancel, so that nothing runs away.
    const double mean = torque_ * (dice_.one_in(3) ? 0.1 : 1.0);
    constant(last, -mean);
    if (!spec_.nodes[0].prescribed) constant(0, mean * kinematic_[at(last)] / kinematic_[0]);
    const int count_of_loads = 1 + dice_.below(3);
    for (int i = 0; i < count_of_loads; ++i) add_load(dice_.below(count()));
  }

  void constant(int node, double torque) {
    Load l{.kind = Load::Kind::table_in_time, .node = node, .times = {0.0}, .torques = {torque}};
    if (!periodic_ && dice_.one_in(4)) ramp_ = true;
    if (ramp_) l.times = {0.0, 0.005}, l.torques = {0.2 * torque, torque};
    spec_.loads.push_back(l);
  }

  void add_load(int node) {
    Load l{.node = node};
    const double size = torque_ * (traits_.lively ? dice_(1.0, 4.0) : dice_(0.3, 2.0));
    const int kind = dice_.below(4);
    l.actual_angle = traits_.feedback && !dice_.one_in(3);
    if (kind == 0 && !periodic_) {
      const double t = dice_(0.002, 0.02), u = dice_(0.003, 0.02);
      l.kind = Load::Kind::table_in_time;
      l.times = {t, t + u, t + 2 * u, t + 2 * u};
      l.torques = {0.0, size, -size, 0.0};
    } else if (kind == 1 || !turns_) {
      l.kind = Load::Kind::harmonics_in_time;
      const double f = periodic_ ? speed_ / kTwoPi * (1 + dice_.below(4)) : dice_.logarithmic(20.0, 400.0);
      l.harmonics = {{f, size, dice_.phase()}};
      if (dice_.one_in(2)) l.harmonics.push_back({2.0 * f, 0.3 * size, dice_.phase()});
    } else if (kind == 2) {
      l.kind = Load::Kind::harmonics_in_angle;
      l.mean = 0.0;
      for (int i = 1 + dice_.below(3); i > 0; --i)
        l.harmonics.push_back({order(node, 1 + dice_.below(5)), size / (1 + i), dice_.phase()});
    } else {
      l.kind = Load::Kind::table_in_angle;
      l.phase = dice_.phase();
      const int points = 4 + dice_.below(9);
      for (int i = 0; i < points; ++i) {
        l.table.arguments.push_back(kTwoPi * (i + dice_(0.0, 0.7)) / points);
        l.table.values.push_back(size * dice_(-1.0, 1.0));
      }
      l.table.period = kTwoPi;
      if (periodic_) {  // one turn of the node is one turn of the reference shaft
        for (double& a : l.table.arguments) a *= std::abs(kinematic_[at(node)]);
        l.table.period *= std::abs(kinematic_[at(node)]);
      }
    }
    spec_.loads.push_back(l);
  }

  /// Of the node, so that a periodic model has the period of the reference shaft.
  double order(int node, int whole) const {
    return periodic_ ? whole / std::abs(kinematic_[at(node)]) : 0.5 * whole;
  }

  void add_damping() {
    if (!traits_.lively && (periodic_ || !dice_.one_in(3)))
      spec_.rayleigh_stiffness = dice_.logarithmic(2e-6, 3e-5);
    if (periodic_ || dice_.one_in(2)) spec_.rayleigh_mass = periodic_ ? dice_(20.0, 80.0) : dice_(0.0, 5.0);
    for (int i = 0; i < count(); ++i)
      if (dice_.one_in(4)) spec_.dashpots.push_back({i, -1, 0.0, dice_(0.0, turns_ ? 0.02 : 0.3)});
    if (count() > 2 && dice_.one_in(4)) spec_.dashpots.push_back({0, count() - 1, 0.0, turns_ ? 0.01 : 0.2});
  }

  /// Of nodes that are no gear's second one; beside what a torque twists.
  void set_initial() {
    if (periodic_ || dice_.one_in(3)) return;
    for (int i = 0; i < count(); ++i) {
      const bool second =
          std::any_of(spec_.gears.begin(), spec_.gears.end(), [&](const Gear& g) { return g.b == i; });
      if (second || spec_.nodes[at(i)].prescribed || dice_.one_in(2)) continue;
      spec_.nodes[at(i)].speed = dice_(-1.0, 1.0) * torque_ / 200.0;
      if (dice_.one_in(2)) spec_.nodes[at(i)].angle = dice_(-1.0, 1.0) * 2e-4;
    }
  }

  void set_times() {
    spec_.duration = dice_(0.03, 0.08);
    if (traits_.run_up && spec_.nominal.node >= 0 && !dice_.one_in(3)) {
      spec_.nominal.omega_0 = speed_ * dice_(0.2, 0.8);
      spec_.nominal.t_0 = dice_(0.0, 0.01);
      spec_.nominal.t_1 = spec_.duration * dice_(0.6, 1.3);
    }
    if (periodic_) spec_.period = kTwoPi / speed_;
  }

  Dice dice_;
  Traits traits_;
  bool periodic_;
  Spec spec_;
  std::vector<double> kinematic_;  // ratio to node 0
  double speed_ = 0.0, torque_ = 0.0;
  bool turns_ = false, ramp_ = false;
};

}  // namespace

Spec random_spec(unsigned seed) { return Maker(seed, kFamilies[seed % 10], false).make(); }

Spec random_periodic_spec(unsigned seed) {
  constexpr Traits families[] = {{.name = "periodic, linear"},
                                 {.name = "periodic, backlash", .gaps = true},
                                 {.name = "periodic, feedback", .feedback = true}};
  return Maker(seed, families[seed % 3], true).make();
}

Spec random_chaotic_spec(unsigned seed) {
  Dice dice(seed);
  Spec spec;
  spec.name = "chaotic " + std::to_string(seed);
  spec.family = "chaotic";
  const double inertia = dice.logarithmic(0.01, 0.1), stiffness = dice.logarithmic(5e3, 5e4);
  const double omega = std::sqrt(stiffness / inertia), torque = dice.logarithmic(20.0, 100.0);
  spec.nodes = {{.inertia = 1.0, .prescribed = true}, {.inertia = inertia}};
  const double half = torque / stiffness * dice(1.7, 2.4), reach = 3 * half;
  spec.polylines = {{.a = 0,
                     .b = 1,
                     .x = {-reach, -half, half, reach},
                     .y = {-stiffness * (reach - half), 0.0, 0.0, stiffness * (reach - half)}}};
  spec.dashpots = {{.a = 1, .b = -1, .damping = dice(0.06, 0.12) * inertia * omega}};
  const double f = omega / kTwoPi * dice(0.9, 1.1);
  spec.loads = {
      {.kind = Load::Kind::harmonics_in_time, .node = 1, .harmonics = {{f, torque, dice.phase()}}},
      {.kind = Load::Kind::table_in_time, .node = 1, .times = {0.0}, .torques = {torque * dice(0.1, 0.3)}}};
  if (dice.one_in(3)) {
    spec.nodes.push_back({.inertia = inertia * dice(0.05, 0.2)});
    spec.shafts = {{.a = 1, .b = 2, .stiffness = stiffness * dice(1.0, 4.0), .damping = 0.0}};
  }
  spec.period = 1.0 / f;
  spec.duration = 400 * spec.period;
  return spec;
}

}  // namespace coverage
