/// The six-cylinder diesel with each cylinder misfiring, without a damper and with each kind of one on its free end: the sweep
/// over orders and a settled run in time agree, and the power put in is the heat.
#include <drev/core/channel.hpp>
#include <drev/core/element.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/published/six_cylinder_train.hpp"

using namespace drev;
using test::diesel, test::shaft_of, test::train;

namespace {

/// A damper as methods in time see it: without what only the frequency domain knows of its loss factor.
class InTime final : public Element {
 public:
  explicit InTime(TorsionalDamper::Params p) : damper_(std::move(p)) {}
  std::string_view type() const override { return "damper in time"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override { return damper_.internal_nodes(); }
  void check(ParameterCheck& check) const override { damper_.check(check); }
  void describe(int nodes, Terms& terms) const override {
    damper_.describe(nodes, terms);
    terms.frequency_stiffnesses.clear();
  }

 private:
  TorsionalDamper damper_;
};

constexpr double kSpeed = 2000.0 * kPi / 30.0, kCycle = 2.0 * kTwoPi / kSpeed;

/// With a spline without the curve's jump, so that its orders fall with their fourth power; 0: no cylinder misfires.
EngineCylinders::Params smooth_diesel(int misfiring) {
  EngineCylinders::Params engine = diesel("1-4-2-6-3-5", misfiring);
  engine.gas.interpolation = Interpolation::cubic;
  engine.gas.angle.pop_back(), engine.gas.pressure.pop_back();
  engine.twist_feedback = false;
  return engine;
}

/// Damped enough to settle within four cycles, and braked by the engine's mean torque.
Model braked_train(const EngineCylinders::Params& engine, double mean) {
  Model m = train(0.0, kSpeed, engine, 0.3);
  m.add<EngineOrderTorque>("brake", {"n8"}, {.mean = -mean});
  m.add<AbsoluteDamper>("grid", {"n8"}, {.damping = 500.0});
  return m;
}

double mean_torque_of(const EngineCylinders::Params& engine) {
  const EngineCylinders alone(engine);
  double mean = 0.0;
  for (int k = 0; k < 6; ++k) mean += alone.mean_torque(k, kSpeed);
  return mean;
}

LinearSweep by_orders(const System& system) {
  std::vector<double> orders;
  for (int k = 1; k <= 1200; ++k) orders.push_back(0.5 * k);  // beyond all natural frequencies
  return sweep_linear(system, {.speeds = {kSpeed}, .orders = orders, .refine = false, .threads = 1});
}

/// Largest difference of the flywheel shaft's torque in the fifth cycle from the sweep's, over its half range.
double difference_in_time(const System& system, const LinearSweep& sweep) {
  constexpr int kSettling = 4, kPoints = 48;  // cycles: by exp(-20) or more; points a cycle
  const SweepSection& shaft = shaft_of(sweep, 8);
  Recorder recorder(system, {"shaft_8.torque_Nm"}, kCycle / kPoints);
  CHECK(propagate(system, {.tolerance = 1e-9, .t_end = (kSettling + 1) * kCycle}, {&recorder}).ok());
  double worst = 0.0;
  for (std::size_t i = kSettling * kPoints; i <= (kSettling + 1) * kPoints; ++i) {
    const double phi = kSpeed * kCycle / kPoints * static_cast<double>(i);
    double expected = shaft.mean[0];
    for (std::size_t k = 0; k < sweep.orders.size(); ++k)
      expected += (shaft.amplitude(Eigen::Index(k), 0) * std::polar(1.0, sweep.orders[k] * phi)).real();
    worst = std::max(worst, std::abs(recorder.samples(0)[i] - expected));
  }
  return worst / shaft.half_range()[0];
}

}  // namespace

TEST_CASE("Each cylinder misfiring: sweep and settled run in time agree, order 0.5 tells", "[engine][once]") {
  double firing_half_order = 0.0;
  for (int misfiring = 0; misfiring <= 6; ++misfiring) {
    INFO(misfiring);
    const EngineCylinders::Params engine = smooth_diesel(misfiring);
    const System system = braked_train(engine, mean_torque_of(engine)).build();
    const LinearSweep sweep = by_orders(system);
    CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-11));
    CHECK(difference_in_time(system, sweep) < 1e-6);
    const double half_order = std::abs(shaft_of(sweep, 8).amplitude(0, 0));
    if (misfiring == 0) firing_half_order = half_order;
    if (misfiring > 0) CHECK(half_order > 20.0 * firing_half_order);
  }
}

TEST_CASE("Each kind of damper, each cylinder misfiring: sweep and settled run agree, input is heat",
          "[engine][once]") {
  const TorsionalDamper::Params viscous{.hub_inertia = 0.02, .ring_inertia = 0.08, .damping = 60.0},
      oil{.ring_inertia = 0.08, .natural_frequency = 200.0, .damping_ratio = 0.25},
      rubber{.ring_inertia = 0.05,
             .natural_frequency = 220.0,
             .spring = {.loss_factor = 0.25, .lowest_frequency = 150, .highest_frequency = 300},
             .damping = 10.0};
  for (int misfiring = 1; misfiring <= 6; ++misfiring) {
    const EngineCylinders::Params engine = smooth_diesel(misfiring);
    const double mean = mean_torque_of(engine);
    for (const TorsionalDamper::Params* damper : {&viscous, &rubber, &oil}) {
      INFO(misfiring << (damper == &viscous ? " viscous" : damper == &rubber ? " rubber" : " oil"));
      Model m = braked_train(engine, mean), in_time = m;
      m.add<TorsionalDamper>("damper", {"n0"}, *damper);
      in_time.add("damper", {"n0"}, std::make_shared<const InTime>(*damper));
      const System system = m.build();
      // Exact in the frequency domain: input is heat, that of the elements too.
      const LinearSweep exact = by_orders(system);
      CHECK(exact.input_power[0] == Approx(exact.dissipated_power[0]).epsilon(1e-9));
      double heat = 0.0;
      for (const SweepSection& section : exact.sections) heat += section.heat[0];
      CHECK(heat == Approx(exact.dissipated_power[0]).epsilon(1e-9));
      // The chain that stands for rubber in time is within its stated error; the others are the same.
      const LinearSweep sweep = by_orders(in_time.build());
      CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-9));
      CHECK(std::abs(shaft_of(exact, 8).half_range()[0] / shaft_of(sweep, 8).half_range()[0] - 1.0) <
            (damper == &rubber ? TorsionalDamper(rubber).spring().fit_error() : 1e-12));
      CHECK(difference_in_time(system, sweep) < 1e-6);
    }
  }
}
