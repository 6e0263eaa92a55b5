// Linear sweeps against closed forms, exact propagation and brute force.
// Covers solvers/periodic/linear_response.hpp, order_content.hpp, trigonometric_sum.hpp,
// trigonometric_kernels.hpp, lane_sections.hpp and sweep_peaks.hpp through sweep_linear(), and solvers/periodic/bracketed_search.hpp.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>
#include <complex>
#include <random>

#include "solvers/periodic/bracketed_search.hpp"
#include "solvers/periodic/trigonometric_sum.hpp"
#include "tests/catch.hpp"
#include "tests/problems/square_law.hpp"

using namespace drev;

namespace {

using Complex = std::complex<double>;

/// J on a shaft to a node of constant speed, 100 N m of order 1 on it; with a damper's ring mu J beside it.
struct DampedDisc {
  double inertia = 2.0, stiffness = 8e4, torque = 100.0;
  double ratio = 0.0, ring_stiffness = 0.0, ring_damping = 0.0;

  System system() const {
    Model m("damped disc");
    for (const char* node : {"clock", "hub", "ring"}) m.add_node(node);
    m.constant_speed("clock", 150.0);
    m.add<ShaftSpring>("shaft", {"clock", "hub"}, {.stiffness = stiffness});
    m.add<Inertia>("J_hub", {"hub"}, {.inertia = inertia});
    m.add<Inertia>("J_ring", {"ring"}, {.inertia = ratio * inertia});
    m.add<Dashpot>("damper", {"hub", "ring"}, {.damping = ring_damping});
    if (ring_stiffness > 0.0)
      m.add<ShaftSpring>("ring_spring", {"hub", "ring"}, {.stiffness = ring_stiffness});
    m.add<EngineOrderTorque>("torque", {"hub"}, {.harmonics = {{1.0, torque, 0.0}}, .twist_feedback = false});
    return m.build();
  }
};

const SweepSection& section_of(const LinearSweep& sweep, const std::string& name) {
  for (const SweepSection& section : sweep.sections)
    if (section.name == name) return section;
  throw std::runtime_error("no section " + name);
}

/// Largest half range of a section, refined.
SweepPeak peak_of(const LinearSweep& sweep, const std::string& name) {
  for (const SweepPeak& peak : sweep.peaks)
    if (sweep.sections[static_cast<std::size_t>(peak.section)].name == name) return peak;
  return {};
}

/// Between a clock and free end: three discs with drag, excited by two orders and a half one.
Model three_discs(double speed) {
  Model m("three discs");
  for (const char* node : {"clock", "a", "b", "c"}) m.add_node(node);
  m.constant_speed("clock", speed);
  m.add<ShaftSpring>("first", {"clock", "a"}, {.stiffness = 9e3, .damping = 4.0});
  m.add<ShaftSpring>("second", {"a", "b"}, {.stiffness = 7e3, .damping = 3.0});
  m.add<ShaftSpring>("third", {"b", "c"}, {.stiffness = 5e3, .damping = 5.0});
  m.add<Inertia>("J_a", {"a"}, {.inertia = 0.3});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 0.5});
  m.add<Inertia>("J_c", {"c"}, {.inertia = 0.2});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 2.0, .beta_stiffness = 1e-5});
  m.add<EngineOrderTorque>("gas", {"b"},
                           {.harmonics = {{0.5, 20.0, 0.4}, {2.0, 35.0, -1.1}, {3.0, 12.0, 2.0}},
                            .mean = 30.0,
                            .twist_feedback = false});
  m.add<EngineOrderTorque>("pump", {"c"},
                           {.harmonics = {{3.0, 9.0, 0.7}}, .mean = -8.0, .twist_feedback = false});
  return m;
}

}  // namespace

TEST_CASE("Optimal viscous damper: peak 1 + 2/mu, heat, at the speed of the closed form", "[linear_sweep]") {
  const double mu = 0.25, natural = 200.0;
  // zeta = c / (2 J_ring w_n) = 1 / sqrt(2 (1 + mu) (2 + mu)), peak at w_n sqrt(2 / (2 + mu))
  const DampedDisc p{.ratio = mu,
                     .ring_damping = 2.0 * 2.0 * mu * natural / std::sqrt(2.0 * (1.0 + mu) * (2.0 + mu))};
  const double worst = natural * std::sqrt(2.0 / (2.0 + mu));
  const LinearSweep at = sweep_linear(p.system(), {.speeds = {worst}, .orders = {1.0}});
  CHECK(section_of(at, "shaft.torque_Nm").half_range()[0] == Approx(900.0).epsilon(1e-12));
  CHECK(section_of(at, "shaft.torque_Nm").twist_half_range[0] == Approx(900.0 / 8e4).epsilon(1e-12));
  CHECK(section_of(at, "damper.torque_Nm").twist_half_range[0] == Approx(8.38525492e-3).epsilon(1e-9));
  CHECK(section_of(at, "damper.torque_Nm").heat[0] == Approx(105.409255).epsilon(1e-8));
  CHECK(at.input_power[0] == Approx(105.409255).epsilon(1e-8));
  CHECK(at.dissipated_power[0] == Approx(at.input_power[0]).epsilon(1e-12));
  // The ring runs with the hub: no mean torque anywhere.
  CHECK(std::abs(section_of(at, "shaft.torque_Nm").mean[0]) < 1e-9);

  const LinearSweep coarse = sweep_linear(p.system(), {.speeds = {50.0, 120.0, 300.0}, .orders = {1.0}});
  const SweepPeak peak = peak_of(coarse, "shaft.torque_Nm");
  CHECK(peak.half_range == Approx(900.0).epsilon(1e-12));
  CHECK(peak.speed == Approx(worst).epsilon(1e-6));
}

TEST_CASE("Tuned damper: the true peak beside the fixed points", "[linear_sweep]") {
  // Den Hartog's tuning and Brock's damping; peaks found by a separate program.
  const double natural = 200.0, torque = 100.0;
  for (const auto& [mu, expected] : {std::pair{0.05, 6.408443170}, {0.1, 4.590220175}, {0.2, 3.327539404}}) {
    const double ring = 2.0 * mu, tuned = natural / (1.0 + mu);
    const DampedDisc p{
        .torque = torque,
        .ratio = mu,
        .ring_stiffness = ring * tuned * tuned,
        .ring_damping = 2.0 * ring * natural * std::sqrt(3.0 * mu / (8.0 * std::pow(1.0 + mu, 3)))};
    const LinearSweep sweep = sweep_linear(p.system(), {.speeds = {60.0, 300.0}, .orders = {1.0}});
    CHECK(peak_of(sweep, "shaft.torque_Nm").half_range / torque == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("A resonance a thousand times narrower than the grid is found", "[linear_sweep]") {
  Model m("narrow");
  m.add_node("clock"), m.add_node("disc");
  m.constant_speed("clock", 10.0);
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 800.0, .damping = 4e-4});
  m.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  m.add<EngineOrderTorque>("torque", {"disc"}, {.harmonics = {{2.0, 5.0, 0.3}}, .twist_feedback = false});
  // w_n = 20 rad/s, met by order 2 at 10 rad/s; 2 zeta = c w_n / k = 1e-5
  const LinearSweep sweep = sweep_linear(m.build(), {.speeds = {5.3, 9.1, 14.7}, .orders = {2.0}});
  REQUIRE(sweep.criticals.size() == 1);
  CHECK(sweep.criticals[0].mode == 0);
  CHECK(sweep.criticals[0].order == 2.0);
  CHECK(sweep.criticals[0].damping_ratio == Approx(5e-6).epsilon(1e-6));
  CHECK(sweep.criticals[0].speed == Approx(10.0).epsilon(1e-8));
  CHECK(sweep.criticals[0].amplitude == Approx(5.0 * 1e5).epsilon(1e-8));
  CHECK(peak_of(sweep, "shaft.torque_Nm").half_range == Approx(5.0 * 1e5).epsilon(1e-8));

  // Without damping nothing bounds it, and the list says so.
  Model bare("bare");
  bare.add_node("clock"), bare.add_node("disc");
  bare.constant_speed("clock", 10.0);
  bare.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 800.0});
  bare.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  bare.add<EngineOrderTorque>("torque", {"disc"}, {.harmonics = {{2.0, 5.0, 0.3}}, .twist_feedback = false});
  const LinearSweep unbounded = sweep_linear(bare.build(), {.speeds = {5.0, 14.0}, .orders = {2.0}});
  REQUIRE(unbounded.criticals.size() == 1);
  CHECK(std::isinf(unbounded.criticals[0].amplitude));
  CHECK(unbounded.criticals[0].speed == Approx(10.0).epsilon(1e-9));
}

TEST_CASE("A sweep is what a run settles on", "[linear_sweep]") {
  const double speed = 41.0;
  const System system = three_discs(speed).build();
  const LinearSweep sweep =
      sweep_linear(system, {.speeds = {speed}, .orders = {0.5, 2.0, 3.0}, .refine = false});
  const double cycle = 2.0 * kTwoPi / speed;  // of half an order; the slowest mode decays at more than 1/s
  CHECK(sweep.cycle == Approx(2.0 * kTwoPi).epsilon(1e-15));
  const double settled = cycle * std::ceil(40.0 / cycle);
  const std::vector<std::string> names{"first.torque_Nm", "second.torque_Nm", "third.torque_Nm"};
  Peaks peaks(find_channels(system, names));
  AfterTime after(settled, {&peaks});
  State state = State::initial(system);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-13, .t_end = settled + 1.01 * cycle}, state, {&after});
  REQUIRE(run.ok());
  for (std::size_t c = 0; c < names.size(); ++c) {
    const SweepSection& section = sweep.sections[c];
    REQUIRE(section.name == names[c]);
    const double scale = section.half_range()[0];
    CHECK(std::abs(section.mean[0] + section.maximum[0] - peaks.peaks()[c].max) < 1e-9 * scale);
    CHECK(std::abs(section.mean[0] + section.minimum[0] - peaks.peaks()[c].min) < 1e-9 * scale);
    // At the angles given, the sum is what it is said to be.
    for (const auto& [angle, value] : {std::pair{section.maximum_angle[0], section.maximum[0]},
                                       std::pair{section.minimum_angle[0], section.minimum[0]}}) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < 3; ++k)
        sum += (section.amplitude(k, 0) * std::polar(1.0, sweep.orders[static_cast<std::size_t>(k)] * angle))
                   .real();
      CHECK(std::abs(sum - value) < 1e-12 * scale);
    }
  }
  CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-12));
}

TEST_CASE("Free discs: torque by order, and a mean torque that does not balance", "[linear_sweep]") {
  const double j_1 = 2.0, j_2 = 3.0, k = 5e4, speed = 30.0;
  const auto model = [&] {
    Model m("free");
    m.add_node("engine"), m.add_node("load");
    m.add<Inertia>("J_1", {"engine"}, {.inertia = j_1});
    m.add<Inertia>("J_2", {"load"}, {.inertia = j_2});
    m.add<ShaftSpring>("shaft", {"engine", "load"}, {.stiffness = k});
    m.add<EngineOrderTorque>("gas", {"engine"},
                             {.harmonics = {{1.5, 40.0, 0.2}}, .mean = 100.0, .twist_feedback = false});
    m.set_reference("engine", constant_speed(-speed));  // backwards
    return m;
  };
  LinearSweepOptions options{.speeds = {speed}, .orders = {1.5}, .refine = false};
  const LinearSweep sweep = sweep_linear(model().build(), options);
  // twist = -T J_2 / (J_1 J_2 w^2 ... ): k_dyn = k - w^2 J_1 J_2 / (J_1 + J_2)
  const double w = 1.5 * speed,
               shaft = -40.0 * k * (j_2 / (j_1 + j_2)) / (k - w * w * j_1 * j_2 / (j_1 + j_2));
  CHECK(std::abs(sweep.sections[0].amplitude(0, 0) - shaft * std::polar(1.0, 0.2)) < 1e-11 * std::abs(shaft));
  REQUIRE(sweep.floating_parts.size() == 1);
  CHECK(sweep.unbalanced[0][0] == Approx(100.0).epsilon(1e-12));
  CHECK(sweep.unbalanced_scale[0] == Approx(100.0).epsilon(1e-12));
  CHECK(sweep.sections[0].mean[0] == Approx(-100.0 * j_2 / (j_1 + j_2)).epsilon(1e-12));  // it speeds up
  options.balance = "load";
  CHECK(sweep_linear(model().build(), options).sections[0].mean[0] == Approx(-100.0).epsilon(1e-12));
  Model balanced = model();
  balanced.add<EngineOrderTorque>("brake", {"load"}, {.mean = -100.0});
  const LinearSweep even = sweep_linear(balanced.build(), {.speeds = {speed}, .orders = {1.5}});
  CHECK(std::abs(even.unbalanced[0][0]) < 1e-9);
  CHECK(even.sections[0].mean[0] == Approx(-100.0).epsilon(1e-12));
}

TEST_CASE("Tables over the angle: their orders are exact, and what is left out is said", "[linear_sweep]") {
  // A triangle of amplitude 12: 8 A / (pi n)^2 for odd n, of the node's two turns.
  const double amplitude = 12.0, stiffness = 4e3, speed = 25.0;
  Model m("triangle");
  m.add_node("clock"), m.add_node("disc");
  m.constant_speed("clock", speed);
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = stiffness});
  m.add<Inertia>("J", {"disc"}, {.inertia = 0.05});
  m.add<CamTorque>(
      "cam", {"disc"},
      {.angle_table = PeriodicTable({0.0, kTwoPi}, {amplitude, -amplitude}, 2.0 * kTwoPi), .phase = 0.4});
  const LinearSweep sweep =
      sweep_linear(m.build(), {.speeds = {speed}, .orders = {0.5, 1.0, 1.5, 2.5}, .refine = false});
  double square = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double n = 2.0 * sweep.orders[k], w = sweep.orders[k] * speed;
    const double torque = n == 2.0 ? 0.0 : 8.0 * amplitude / (kPi * kPi * n * n);
    square += 0.5 * torque * torque;
    const Complex expected = torque * std::polar(1.0, 0.5 * n * 0.4) * stiffness / (stiffness - w * w * 0.05);
    CHECK(std::abs(sweep.sections[0].amplitude(static_cast<Eigen::Index>(k), 0) - expected) <
          1e-12 * amplitude);
  }
  REQUIRE(sweep.left_out.size() == 1);
  const double all = amplitude * amplitude / 3.0;
  CHECK(sweep.left_out[0].load == "cam");
  CHECK(sweep.left_out[0].share == Approx(std::sqrt((all - square) / all)).epsilon(1e-8));
}

TEST_CASE("What a linear sweep cannot take is refused with its places, all at once", "[linear_sweep]") {
  Model m("refused");
  for (const char* node : {"crank", "gear", "load"}) m.add_node(node);
  m.constant_speed("crank", 50.0);
  m.add<GearMesh>("mesh", {"crank", "gear"},
                  {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e8, .normal_backlash = 1e-4});
  m.add<ShaftSpring>("shaft", {"gear", "load"}, {.stiffness = 1e4});
  m.add<Inertia>("J_g", {"gear"}, {.inertia = 0.1});
  m.add<Inertia>("J_l", {"load"}, {.inertia = 0.1});
  for (const char* node : {"drum", "case"}) {
    m.add_node(node);
    m.add<Inertia>("J_" + std::string(node), {node}, {.inertia = 0.1});
  }
  m.add<LossyGear>("worm", {"load", "drum"},
                   {.ratio = 0.1, .efficiency_forward = 0.8, .efficiency_backward = 0.7});
  m.add<Clutch>("clutch", {"drum", "case"}, {.torque = 5.0});
  m.add<AppliedTorque>("pulse", {"load"}, {.torque = [](double t) { return t < 0.1 ? 5.0 : 0.0; }});
  try {
    sweep_linear(m.build(), {.speeds = {50.0}, .sections = {"shaft.torque_Nm", "shat.torque_Nm"}});
    FAIL("not refused");
  } catch (const ModelError& error) {
    const std::string text = error.what();
    CHECK(error.findings().size() == 4);  // dry friction once, however many contacts
    for (const char* part :
         {"mesh", "close_contacts", "worm is a lossy gear, which sticks and slips: a sweep does", "exact",
          "pulse", "has no orders", "shat", "did you mean"})
      CHECK(text.find(part) != std::string::npos);
  }
  const System system = three_discs(20.0).build();
  CHECK_THROWS_AS(sweep_linear(system, {}), ModelError);
  CHECK_THROWS_AS(sweep_linear(system, {.speeds = {20.0, 10.0}}), ModelError);
  CHECK_THROWS_AS(sweep_linear(system, {.speeds = {20.0}, .orders = {0.0, 1.0}}), ModelError);
  CHECK_THROWS_AS(sweep_linear(system, {.speeds = {20.0}, .orders = {1.0, kPi}}), ModelError);
  CHECK_THROWS_AS(sweep_linear(system, {.speeds = {20.0}, .balance = "a"}), ModelError);
}

TEST_CASE("Closed contacts on request, where teeth would separate is said", "[linear_sweep]") {
  const double stiffness = 1e6, damping = 30.0, radius = 0.2, inertia = 0.1, speed = 50.0;
  const auto with_mean = [&](double mean) {
    Model m("mesh");
    for (const char* node : {"crank", "gear"}) m.add_node(node);
    m.constant_speed("crank", speed);
    m.add<GearMesh>("mesh", {"crank", "gear"},
                    {.base_radius_1 = 0.5 * radius,
                     .base_radius_2 = radius,
                     .stiffness = stiffness,
                     .normal_backlash = 1e-4,
                     .damping = damping});
    m.add<Inertia>("J", {"gear"}, {.inertia = inertia});
    m.add<EngineOrderTorque>("load", {"gear"},
                             {.harmonics = {{2.0, 10.0, 0.7}}, .mean = mean, .twist_feedback = false});
    return sweep_linear(m.build(),
                        {.speeds = {speed}, .orders = {1.0}, .close_contacts = true, .refine = false});
  };
  // The gear turns at half the speed, backwards: its order 2 is order 1 of the crank, its phase the other way.
  const LinearSweep firm = with_mean(50.0);
  const SweepSection& mesh = firm.sections[0];
  const Complex law(stiffness, speed * damping);
  const Complex force =
      radius * law * std::polar(10.0, -0.7) / (radius * radius * law - speed * speed * inertia);
  CHECK(mesh.name == "mesh.force_N");
  CHECK(std::abs(mesh.amplitude(0, 0) - force) < 1e-12 * std::abs(force));
  CHECK(mesh.mean[0] == Approx(50.0 / radius).epsilon(1e-12));
  CHECK(mesh.heat[0] == Approx(0.5 * damping * std::norm(speed * force / law)).epsilon(1e-12));
  CHECK_FALSE(mesh.separates(0));
  CHECK(with_mean(5.0).sections[0].separates(0));
}

TEST_CASE("A load that follows the speed damps with its slope, at every speed", "[linear_sweep]") {
  const double k = 800.0, inertia = 2.0, factor = 0.05;
  Model m("fan");
  m.add_node("clock"), m.add_node("disc");
  m.constant_speed("clock", 10.0);
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = k});
  m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
  m.add<SquareLaw>("fan", {"disc"}, {.factor = factor});
  m.add<EngineOrderTorque>("torque", {"disc"}, {.harmonics = {{2.0, 5.0, 0.3}}, .twist_feedback = false});
  const LinearSweep sweep = sweep_linear(m.build(), {.speeds = {4.0, 7.0, 16.0}, .orders = {2.0}});
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double speed = sweep.speeds[static_cast<std::size_t>(i)], w = 2.0 * speed, c = 2.0 * factor * speed;
    const Complex expected = k * std::polar(5.0, 0.3) / Complex(k - w * w * inertia, w * c);
    CHECK(std::abs(sweep.sections[0].amplitude(0, i) - expected) < 1e-12 * std::abs(expected));
    CHECK(sweep.sections[0].mean[i] == Approx(-factor * speed * speed).epsilon(1e-12));
  }
  REQUIRE(sweep.modes.lambda.rows() == 1);
  REQUIRE(sweep.modes.speeds.size() == 9);
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double decay = factor * sweep.modes.speeds[i] / inertia;
    CHECK(std::abs(sweep.modes.lambda(0, i) - Complex(-decay, std::sqrt(k / inertia - decay * decay))) <
          1e-9);
  }
  // c grows with w: |k / (k - (2 w)^2 J + 2 i w c)| is largest where d/dw of the squared denominator is 0.
  REQUIRE(sweep.criticals.size() == 1);
  const double w = sweep.criticals[0].speed;
  CHECK(std::abs(-16.0 * w * inertia * (k - 4.0 * w * w * inertia) + 64.0 * factor * factor * w * w * w) <
        1e-5 * k * k / w);
}

TEST_CASE("The extremes of sums are those of a fine search", "[linear_sweep]") {
  std::mt19937 draw(5);
  std::normal_distribution<double> number;
  const std::vector<double> orders{0.5, 1.0, 2.5, 4.0, 7.5, 12.0};
  TrigonometricSum sum(orders, "test");
  CHECK(sum.base_order() == Approx(0.5));
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::MatrixXcd a(6, 1);
    for (Eigen::Index k = 0; k < 6; ++k)
      a(k, 0) = Complex(number(draw), number(draw)) / (trial % 2 ? 1.0 : 1.0 + double(k * k));
    std::vector<SumExtremes> found;
    sum.extremes(a, found);
    double max = -1e9, min = 1e9;
    const int points = 200000;
    for (int s = 0; s < points; ++s) {
      double y = 0.0;
      for (Eigen::Index k = 0; k < 6; ++k)
        y += (a(k, 0) * std::polar(1.0, orders[static_cast<std::size_t>(k)] * 2.0 * kTwoPi * s / points))
                 .real();
      max = std::max(max, y), min = std::min(min, y);
    }
    const double size = a.cwiseAbs().sum();  // the search misses (n h)^2 / 8 = 7e-8 of it at most
    CHECK(found[0].max >= max - 1e-14 * size);
    CHECK(found[0].max <= max + 1e-7 * size);
    CHECK(found[0].min <= min + 1e-14 * size);
    CHECK(found[0].min >= min - 1e-7 * size);
  }
}

TEST_CASE("The extremes of many sums of 24 orders are those of a fine search", "[linear_sweep]") {
  // Amplitudes that fall with the order, so that flat tops occur whose highest place has no point beside it that is
  // higher than its neighbours, and tops whose parabola points elsewhere.
  constexpr int kPoints = 2400, kOrders = 24, kSums = 4800;
  std::mt19937 draw(11);
  std::normal_distribution<double> number;
  std::vector<double> orders;
  for (int k = 1; k <= kOrders; ++k) orders.push_back(0.5 * k);
  Eigen::MatrixXcd a(kOrders, kSums), waves(kPoints, kOrders);
  for (Eigen::Index s = 0; s < kSums; ++s)
    for (int k = 0; k < kOrders; ++k) a(k, s) = Complex(number(draw), number(draw)) / (k + 1.0);
  for (int k = 0; k < kOrders; ++k)
    for (int p = 0; p < kPoints; ++p) waves(p, k) = std::polar(1.0, (k + 1) * kTwoPi * p / kPoints);
  const Eigen::MatrixXd y = (waves * a).real();
  TrigonometricSum sum(orders, "test");
  std::vector<SumExtremes> found;
  sum.extremes(a, found);
  for (Eigen::Index s = 0; s < kSums; ++s) {
    const SumExtremes& e = found[static_cast<std::size_t>(s)];
    const double size = a.col(s).cwiseAbs().sum();  // the search misses (n h)^2 / 8 = 5e-4 of it at most
    const double max = y.col(s).maxCoeff(), min = y.col(s).minCoeff();
    double at_max = 0.0, at_min = 0.0;
    for (int k = 0; k < kOrders; ++k) {
      at_max += (a(k, s) * std::polar(1.0, orders[static_cast<std::size_t>(k)] * e.max_angle)).real();
      at_min += (a(k, s) * std::polar(1.0, orders[static_cast<std::size_t>(k)] * e.min_angle)).real();
    }
    CAPTURE(s);
    CHECK(e.max >= max - 1e-14 * size);
    CHECK(e.max <= max + 5e-4 * size);
    CHECK(std::abs(e.max - at_max) < 1e-13 * size);
    CHECK(e.min <= min + 1e-14 * size);
    CHECK(e.min >= min - 5e-4 * size);
    CHECK(std::abs(e.min - at_min) < 1e-13 * size);
  }
}

TEST_CASE("A bracketed maximum is found to the root of rounding", "[linear_sweep]") {
  int looks = 0;
  const auto bump = [&](double t) { return ++looks, std::exp(-(t - 1.3) * (t - 1.3)) + 0.1 * t; };
  const BracketedMaximum found = bracketed_maximum(0.0, 1.0, 5.0, 1e-9, bump);
  CHECK(std::abs(2.0 * (found.at - 1.3) * std::exp(-std::pow(found.at - 1.3, 2)) - 0.1) < 1e-7);
  CHECK(looks < 40);
  CHECK(bracketed_maximum(0.0, 0.0, 2.0, 1e-9, [](double t) { return t; }).at == Approx(2.0).epsilon(1e-8));
}

TEST_CASE("Criticals of a chain of 500 discs: damped modes one by one, peaks between the speeds",
          "[linear_sweep]") {
  // Uniform chain from a wall to a free end: w_j = 2 sqrt(k/J) sin((2 j - 1) pi / (2 (2 n + 1))); damping b k of each
  // shaft gives the damping ratio b w_j / 2.
  constexpr int kDiscs = 500;
  constexpr double kStiffness = 1e6, kInertia = 0.04, kDamping = 4e-5;
  Model m("chain");
  for (int i = 0; i < kDiscs; ++i) {
    const std::string node = "n" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = kInertia});
    if (i == 0)
      m.add<ShaftSpring>("k0", {"wall", node}, {.stiffness = kStiffness, .damping = kDamping * kStiffness});
    else
      m.add<ShaftSpring>("k" + std::to_string(i), {"n" + std::to_string(i - 1), node},
                         {.stiffness = kStiffness, .damping = kDamping * kStiffness});
  }
  m.add_node("wall");
  m.constant_speed("wall", 60.0);
  m.add<EngineOrderTorque>("gas", {"n" + std::to_string(kDiscs - 1)},
                           {.harmonics = {{1.0, 100.0, 0.0}}, .twist_feedback = false});
  const LinearSweep sweep = sweep_linear(
      m.build(), {.speeds = {20.0, 40.0, 60.0, 80.0}, .orders = {1.0}, .sections = {"k0.torque_Nm"}});
  CHECK(sweep.modes_note.empty());
  std::vector<double> expected;  // of order 1, between the speeds
  for (int j = 1; j < 20; ++j) {
    const double w =
        2.0 * std::sqrt(kStiffness / kInertia) * std::sin((2 * j - 1) * kPi / (2.0 * (2 * kDiscs + 1)));
    if (w > 20.0 && w < 80.0) expected.push_back(w);
  }
  REQUIRE(expected.size() == 2);
  REQUIRE(sweep.criticals.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double ratio = 0.5 * kDamping * expected[i];
    CHECK(sweep.criticals[i].damping_ratio == Approx(ratio).epsilon(1e-8));
    CHECK(hz(sweep.criticals[i].frequency_Hz) ==
          Approx(expected[i] * std::sqrt(1.0 - ratio * ratio)).epsilon(1e-10));
    CHECK(sweep.criticals[i].speed == Approx(expected[i]).epsilon(2e-5));
    // Far above what the speeds of the grid show.
    CHECK(sweep.criticals[i].amplitude > 20.0 * sweep.sections[0].half_range().minCoeff());
  }
}

TEST_CASE("The mean across a coupling with a loss factor is that of the stated stiffness", "[linear_sweep]") {
  // A shaft of k beside a coupling of k (1 + i eta): each has half of the mean torque, and T / (2 k) of twist.
  constexpr double k = 1000.0, mean = 100.0;
  ViscoelasticStiffness::Params constant{
      .stiffness = k, .lowest_frequency = 5, .highest_frequency = 10, .permitted_error = 1.0};
  std::vector<ViscoelasticStiffness::Params> materials;
  for (const double eta : {0.1, 0.3, 0.7, 1.0}) {
    materials.push_back(constant);
    materials.back().loss_factor = eta;
  }
  materials.push_back(constant);
  materials.back().stiffness = kNotGiven;
  materials.back().frequencies = {0.0, 100.0}, materials.back().stiffnesses = {k, 1.2 * k};
  materials.back().loss_factors = {0.3, 0.3};
  for (const ViscoelasticStiffness::Params& material : materials) {
    CAPTURE(material.loss_factor);
    Model m("two paths");
    for (const char* node : {"clock", "a"}) m.add_node(node);
    m.constant_speed("clock", 60.0);
    m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {"clock", "a"}, {.stiffness = k});
    m.add<ElasticCoupling>("rubber", {"clock", "a"}, {.material = material});
    m.add<EngineOrderTorque>("load", {"a"},
                             {.harmonics = {{1.0, 10.0, 0.0}}, .mean = mean, .twist_feedback = false});
    const LinearSweep sweep =
        sweep_linear(m.build(), {.speeds = {20.0, 60.0}, .orders = {1.0}, .refine = false});
    for (const SweepSection& section : sweep.sections)
      for (const Eigen::Index i : {0, 1}) {
        CHECK(section.mean[i] == Approx(0.5 * mean).epsilon(1e-9));
        CHECK(section.twist_mean[i] == Approx(0.5 * mean / k).epsilon(1e-9));
      }
  }
}
