/// The six-cylinder diesel with each kind of damper on its free end and each cylinder misfiring: the sweep over orders and
/// a settled run in time agree, and the power put in is the heat.
#include <drev/core/channel.hpp>
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

}  // namespace

TEST_CASE("Each kind of damper, each cylinder misfiring: sweep and settled run agree, input is heat",
          "[engine][once]") {
  const double speed = rpm(2000.0), cycle = 2.0 * kTwoPi / speed;
  constexpr int kSettling = 4;  // cycles: by exp(-20) or more
  std::vector<double> orders;
  for (int k = 1; k <= 1200; ++k) orders.push_back(0.5 * k);  // beyond all natural frequencies
  const TorsionalDamper::Params viscous{.hub_inertia = 0.02, .ring_inertia = 0.08, .damping = 60.0},
      oil{.ring_inertia = 0.08, .natural_frequency = 200.0, .damping_ratio = 0.25},
      rubber{.ring_inertia = 0.05,
             .natural_frequency = 220.0,
             .spring = {.loss_factor = 0.25, .lowest_frequency = 150, .highest_frequency = 300},
             .damping = 10.0};
  for (int misfiring = 1; misfiring <= 6; ++misfiring) {
    const TorsionalDamper::Params& damper = misfiring <= 2 ? viscous : misfiring <= 4 ? rubber : oil;
    EngineCylinders::Params engine = diesel("1-4-2-6-3-5", misfiring);
    // A spline without the curve's jump: its orders fall with their fourth power.
    engine.gas.interpolation = Interpolation::cubic;
    engine.gas.angle.pop_back(), engine.gas.pressure.pop_back();
    engine.twist_feedback = false;
    double mean = 0.0;
    const EngineCylinders alone(engine);
    for (int k = 0; k < 6; ++k) mean += alone.mean_torque(k, speed);
    const auto with_damper = [&](bool in_time) {
      Model m = train(0.0, speed, engine, 0.3);
      m.add<EngineOrderTorque>("brake", {"n8"}, {.mean = -mean});
      m.add<AbsoluteDamper>("grid", {"n8"}, {.damping = 500.0});
      if (in_time)
        m.add("damper", {"n0"}, std::make_shared<const InTime>(damper));
      else
        m.add<TorsionalDamper>("damper", {"n0"}, damper);
      return m.build();
    };
    const auto sweep_of = [&](const System& system) {
      return sweep_linear(system, {.speeds = {speed}, .orders = orders, .refine = false, .threads = 1});
    };
    const System system = with_damper(false);
    // Exact in the frequency domain: input is heat, that of the elements too.
    const LinearSweep exact = sweep_of(system);
    CHECK(exact.input_power[0] == Approx(exact.dissipated_power[0]).epsilon(1e-9));
    double heat = 0.0;
    for (const SweepSection& section : exact.sections) heat += section.heat[0];
    CHECK(heat == Approx(exact.dissipated_power[0]).epsilon(1e-9));

    const LinearSweep sweep = sweep_of(with_damper(true));
    CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-9));
    const SweepSection& shaft = shaft_of(sweep, 8);
    const double half_range = shaft.half_range()[0];
    // The chain that stands for rubber in time is within its stated error; the others are the same.
    CHECK(std::abs(shaft_of(exact, 8).half_range()[0] / half_range - 1.0) <
          (&damper == &rubber ? TorsionalDamper(rubber).spring().fit_error() : 1e-12));

    Recorder recorder(system, {"shaft_8.torque_Nm"}, cycle / 48.0);
    const RunSummary run =
        propagate(system, {.tolerance = 1e-9, .t_end = (kSettling + 1) * cycle}, {&recorder});
    CHECK(run.ok());
    double worst = 0.0;
    for (std::size_t i = kSettling * 48; i <= (kSettling + 1) * 48; ++i) {
      const double phi = speed * cycle / 48.0 * static_cast<double>(i);
      double expected = shaft.mean[0];
      for (std::size_t k = 0; k < orders.size(); ++k)
        expected += (shaft.amplitude(Eigen::Index(k), 0) * std::polar(1.0, orders[k] * phi)).real();
      worst = std::max(worst, std::abs(recorder.samples(0)[i] - expected));
    }
    INFO(misfiring << ": " << worst / half_range << ", steps " << run.steps);
    CHECK(worst < 1e-6 * half_range);
  }
}
