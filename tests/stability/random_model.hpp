#pragma once
/// Random drivetrains for the stability tests: a tree of shafts with gaps anywhere, loads that step and
/// ramp; `varying` adds what is not linear in pieces.
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/problems/twist_backlash.hpp"

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  double decade(double low, double high) { return std::pow(10.0, (*this)(low, high)); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
  std::mt19937 engine;
};

struct ModelRanges {
  int masses = 12, gaps = 6;  ///< at most
  double decades = 8.0;       ///< of stiffness, at most
  bool varying = false;       ///< cams, engine orders, functions, gear mesh by phase, smooth laws
  double duration = 300.0;    ///< in units of 1/fastest
};

struct RandomModel {
  drev::System system;
  double fastest;  ///< 1/s, rough
  double t_end;    ///< s
};

/// y = k x + k3 x^3 + c x'
struct CubicLaw {
  double k, k3, c;
  drev::ScalarResponse operator()(const drev::ScalarInput& in) const {
    const double x2 = in.x * in.x;
    return {.y = (k + k3 * x2) * in.x + c * in.x_dot,
            .dy_dx = k + 3 * k3 * x2,
            .dy_dx_dot = c,
            .stored_energy = (0.5 * k + 0.25 * k3 * x2) * x2,
            .dissipated_power = c * in.x_dot * in.x_dot};
  }
};

/// A stop at x = gap with damping by penetration: y = k d + c d x', d = max(x - gap, 0).
struct StopLaw {
  std::vector<double> gap;
  double k, c;
  drev::ScalarResponse operator()(const drev::ScalarInput& in) const {
    const double d = in.x - gap[0];
    if (d <= 0.0) return {};
    return {.y = d * (k + c * in.x_dot),
            .dy_dx = k + c * in.x_dot,
            .dy_dx_dot = c * d,
            .stored_energy = 0.5 * k * d * d,
            .dissipated_power = c * d * in.x_dot * in.x_dot};
  }
  std::span<const double> kinks() const { return gap; }
  double closed_stiffness() const { return k; }
};

class RandomModelMaker {
 public:
  RandomModelMaker(unsigned seed, const ModelRanges& ranges)
      : random_(seed), ranges_(ranges), model_("fuzz " + std::to_string(seed)) {}

  RandomModel make() {
    masses_ = 1 + random_.below(ranges_.masses);
    decades_ = random_(0.0, ranges_.decades);
    base_ = random_.decade(0.0, 3.0);
    damped_ = random_.below(2) == 1;
    turns_ = ranges_.varying && masses_ > 1 && random_.below(2);
    for (int i = 0; i < masses_; ++i) add_mass("n" + std::to_string(i));
    for (int i = 1; i < masses_; ++i) add_shaft(i);
    if (!turns_ && random_.below(2))
      model_.add<drev::GroundSpring>("ground", {node(0)}, {.stiffness = stiffness()});
    for (int g = ranges_.gaps > 0 ? random_.below(ranges_.gaps + 1) : 0; g > 0; --g)
      add_gap("gap" + std::to_string(g));
    if (ranges_.varying)
      for (int i = 1 + random_.below(3); i > 0; --i) add_varying(std::to_string(i));
    const double fastest = std::sqrt(4.0 * std::max(stiffest_, base_) / lightest_);
    const double end = ranges_.duration / fastest;
    for (int l = random_.below(3); l > 0; --l) {
      const double torque = load();
      model_.add<drev::AppliedTorque>("load" + std::to_string(l), {any_node()},
                                      {.table = drev::TimeTable({0.1 * end, 0.3 * end, 0.6 * end, 0.6 * end},
                                                                {torque, -torque, 0.5 * torque, 0.0})});
    }
    if (ranges_.varying && random_.below(2)) {
      const double torque = load(), frequency = fastest * random_.decade(-2.0, -0.5);
      model_.add<drev::AppliedTorque>("function", {any_node()},
                                      {.torque = [=](double t) { return torque * std::sin(frequency * t); }});
    }
    if (turns_) model_.set_reference(node(0), drev::constant_speed(fastest * random_.decade(-2.0, 0.0)));
    const double speed = fastest * random_.decade(-2.0, 0.0);
    for (int i = 0; i < masses_; ++i)
      model_.set_initial(node(i), random_(-1.0, 1.0), random_(-1.0, 1.0) * speed);
    return {model_.build(), fastest, end};
  }

 private:
  static std::string node(int i) { return "n" + std::to_string(i); }
  std::string any_node() { return node(random_.below(masses_)); }
  double load() { return random_(-1.0, 1.0) * base_ * random_.decade(0.0, decades_); }
  double stiffness() {
    const double k = base_ * random_.decade(0.0, decades_);
    stiffest_ = std::max(stiffest_, k);
    return k;
  }

  void add_mass(const std::string& name) {
    model_.add_node(name);
    inertia_.push_back(random_.decade(-0.7, 0.7));
    lightest_ = std::min(lightest_, inertia_.back());
    model_.add<drev::Inertia>("J" + name, {name}, {.inertia = inertia_.back()});
  }

  void add_shaft(int i) {
    if (!ranges_.varying && random_.below(5) == 0) return;  // a gap may join them, or nothing
    const double k = stiffness();
    const std::string other = node(random_.below(i));
    model_.add<drev::ShaftSpring>("shaft" + node(i), {other, node(i)}, {.stiffness = k});
    if (damped_ && random_.below(2))
      model_.add<drev::Dashpot>("dashpot" + node(i), {other, node(i)},
                                {.damping = random_(0.0, 0.1) * std::sqrt(k * inertia_[drev::idx(i)])});
  }

  std::vector<drev::NodeRef> ends() {
    int b = random_.below(masses_), a = random_.below(masses_);
    if (a == b && turns_) a = (b + 1) % masses_;
    if (a == b) return {node(b)};
    return {node(a), node(b)};
  }

  void add_gap(const std::string& name) {
    using drev::PolylineSpring, drev::MeshDamping;
    const double k = stiffness(), half = random_.below(6) ? random_(0.01, 1.0) : 0.0;
    const double c = damped_ && random_.below(2) ? random_(0.0, 0.5) * std::sqrt(k * lightest_) : 0.0;
    const int kind = random_.below(6);
    if (kind == 0)
      model_.add(name, ends(), std::make_shared<PolylineSpring>(PolylineSpring::dead_band(k, half, c)));
    else if (kind == 1)
      model_.add(name, ends(),
                 std::make_shared<PolylineSpring>(PolylineSpring::with_stops(0.1 * k, half + 0.1, k, c)));
    else
      model_.add(name, ends(),
                 std::make_shared<drev::LawElement<TwistBacklash>>(
                     TwistBacklash{drev::BacklashLaw({.normal_backlash = 2 * half,
                                                      .damping = c,
                                                      .damping_law = kind == 2   ? MeshDamping::always
                                                                     : kind == 3 ? MeshDamping::contact_only
                                                                                 : MeshDamping::limited}),
                                   k}));
  }

  void add_varying(const std::string& n) {
    const int kind = random_.below(5);
    if (kind == 0) {  // its angle turns back and forth over the knots
      const double period = random_.decade(-0.5, 1.0), slope = 0.3 * stiffness();
      const int points = 3 + random_.below(20);
      std::vector<double> x, y;
      for (int i = 0; i < points; ++i) {
        x.push_back(period * (i + random_(0.0, 0.5)) / points);
        y.push_back(slope * period / points * random_(-0.25, 0.25));
      }
      model_.add<drev::CamTorque>("cam" + n, {any_node()},
                                  {.angle_table = drev::PeriodicTable(x, y, period)});
    } else if (kind == 1) {
      const double order = 0.5 * (1 + random_.below(12));
      model_.add<drev::EngineOrderTorque>(
          "engine" + n, {any_node()}, {.harmonics = {{order, 0.3 * stiffness() / order, random_(0.0, 6.0)}}});
    } else if (kind == 2) {
      const double k = stiffness(), c = damped_ ? 0.1 * std::sqrt(k * lightest_) : 0.0;
      model_.add(n + "cubic", ends(),
                 std::make_shared<drev::LawElement<CubicLaw>>(CubicLaw{0.3 * k, random_(0.0, 0.3) * k, c}));
    } else if (kind == 3) {
      const double k = stiffness();
      model_.add(n + "stop", ends(),
                 std::make_shared<drev::LawElement<StopLaw>>(
                     StopLaw{{random_(-0.5, 1.0)}, k, damped_ ? 0.1 * std::sqrt(k * lightest_) : 0.0}));
    } else {
      using drev::MeshStiffness;
      const double k = stiffness();
      const std::string pinion = "pinion" + n;
      const auto smooth = MeshStiffness::fourier(0.6 * k, {{1.0, 0.2 * k, 0.3}, {2.0, 0.1 * k, 1.0}});
      const auto stepped = [&] {
        const double ratio = random_(1.2, 1.8);
        return MeshStiffness::step(0.7 * k, k, ratio);
      };
      const int teeth_1 = 1 + random_.below(12), teeth_2 = teeth_1 + random_.below(12);
      add_mass(pinion);
      model_.add<drev::GearMesh>("mesh" + n, {pinion, any_node()},
                                 {.base_radius_1 = 1.0,
                                  .base_radius_2 = static_cast<double>(teeth_2) / teeth_1,
                                  .teeth_1 = teeth_1,
                                  .teeth_2 = teeth_2,
                                  .stiffness = random_.below(2) ? stepped() : smooth,
                                  .normal_backlash = random_.below(2) ? random_(0.01, 0.3) : 0.0});
    }
  }

  Random random_;
  ModelRanges ranges_;
  drev::Model model_;
  int masses_ = 1;
  double decades_ = 0.0, base_ = 1.0, stiffest_ = 0.0, lightest_ = 1e9;
  bool damped_ = false, turns_ = false;
  std::vector<double> inertia_;
};

inline RandomModel random_model(unsigned seed, const ModelRanges& ranges) {
  return RandomModelMaker(seed, ranges).make();
}
