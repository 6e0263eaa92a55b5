// Kinks of tables by one backward sweep: the motion behind them in closed form, and long runs beside passes.
// Covers solvers/exact/kink_response.hpp and solvers/exact/kink_moments.hpp, also through propagate().
#include "solvers/exact/kink_response.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "solvers/exact/kink_moments.hpp"
#include "tests/catch.hpp"
#include "tests/unit/solvers/exact/placed_load.hpp"

using namespace drev;

TEST_CASE("Moments of kinks for a sweep: in closed form along a quadratic path") {
  // theta = 0.2 s + 0.5 s^2 passes 0.12 at s_0: jump (theta - 0.12) = jump (theta'(s_0) u + 0.5 u^2), u = s - s_0, and
  // int_0^r (r - u)^j/j! u^n du = n! r^(j+n+1)/(j+n+1)!.
  const std::vector<double> theta{0.0, 0.2, 0.5};
  const double place = -0.2 + std::sqrt(0.04 + 0.24), rate = 0.2 + place, jump = 30.0;
  for (const double end : {1.0, 0.7}) {
    KinkMoments kinks;
    const PlacedLoad load = load_on(2);
    kinks.add(load, 0.12, {&jump, 1}, end * (0.2 + 0.5 * end));
    constexpr int kDegree = 9, kStride = 8;
    std::vector<double> columns(theta.size() *
                                kStride);  // half of theta by the row, half by the nominal motion
    for (std::size_t k = 0; k < theta.size(); ++k) columns[k * kStride + 2] = 0.5 * theta[k];
    kinks.expand(columns.data(), kStride, theta.size(), theta.size(), {0.0, 0.5 * theta[1], 0.5 * theta[2]});
    const auto moments = kinks.find_moments(end, kDegree, 8, theta.size());
    CHECK(kinks.place(0) == Approx(place).epsilon(1e-9));
    REQUIRE(moments.count == 1);
    CHECK(moments.rows[0] == 2);
    double power = end - place, factorial = 1.0;  // r^(j+1), (j+1)!
    for (int j = 0; j <= kDegree; ++j, power *= end - place, factorial *= j + 1) {
      const double r = end - place;
      const double truth = jump * power * r / (factorial * (j + 2)) * (rate + r / (j + 3));
      CHECK(moments.values[j * moments.step] == Approx(truth).epsilon(1e-13));
      for (int lane = 1; lane < kLanes; ++lane) CHECK(moments.values[j * moments.step + lane] == 0.0);
    }
    // The row moves by half of theta: work of the force on it.
    std::vector<double> none(kStride);
    const double work = kinks.work(0.5 * (0.2 + end), 0.5, none.data(), none.data(), none.data());
    const double r = end - place;  // int jump (rate u + u^2/2) (rate + u)/2 du
    CHECK(work == Approx(0.25 * jump * std::pow(rate * r + 0.5 * r * r, 2)).epsilon(1e-13));
  }
}

TEST_CASE("Work of kinks: beside Gauss's rule, with what they add to the motion") {
  // theta = turn (z + y) + phi with z = 0.3 s - 0.1 s^2 and y = bend (s - place)^3 from the knot on. Straight forces, and curved ones
  // without y, whose slope at the end stands for all.
  const std::vector<double> z{0.0, 0.3, -0.1}, force{40.0, -300.0, 1000.0};
  const std::array<double, 3> phi{0.0, 0.9, 0.2};
  constexpr int kStride = 16, kKinks = 11;
  const double end = 0.8;
  const auto place = [](int i) { return 0.25 + 0.04 * i; };
  for (const double turn : {1.0, -0.5, 2.5})
    for (const bool curved : {false, true}) {
      INFO("turn " << turn << (curved ? ", curved" : ", straight"));
      const double bend = curved ? 0.0 : 0.4;
      const auto used = std::span(force).first(curved ? force.size() : 1);
      const auto angle = [&](double s) {
        return turn * (z[1] * s + z[2] * s * s) + phi[1] * s + phi[2] * s * s;
      };
      KinkMoments kinks;
      std::vector<double> columns(3 * kStride), y(kStride), y_sum(kStride), y_sum_2(kStride);
      double truth = 0.0;
      for (int i = 0; i < kKinks; ++i) {
        const auto row = static_cast<std::size_t>(i);
        kinks.add(load_on(i, 0.0, turn), angle(place(i)), used, angle(end));
        for (std::size_t k = 0; k < 3; ++k) columns[k * kStride + row] = z[k];
        const double r = end - place(i);
        y[row] = bend * std::pow(r, 3);
        y_sum[row] = bend * std::pow(r, 4) / 4.0;
        y_sum_2[row] = bend * std::pow(r, 5) / 20.0;
        const GaussRule& rule = gauss_rule();
        for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
          const double u = r * rule.s[q], s = place(i) + u;
          const double x = angle(s) + turn * bend * u * u * u - angle(place(i));
          double f = 0.0;
          for (std::size_t k = used.size(); k-- > 0;) f = (f + turn * used[k]) * x;
          truth += rule.weight[q] * r * f * (z[1] + 2.0 * z[2] * s + 3.0 * bend * u * u);
        }
      }
      kinks.expand(columns.data(), kStride, 3, 3, phi);
      kinks.find_moments(end, 8, 8, 3);
      for (int i = 0; i < kKinks; ++i) CHECK(kinks.place(i) == Approx(place(i)).epsilon(1e-9));
      CHECK(kinks.work(phi[1] + 2.0 * phi[2] * end, 2.0 * phi[2], y.data(), y_sum.data(), y_sum_2.data()) ==
            Approx(truth).epsilon(1e-12));
    }
}

namespace {

/// A disc on a spring against a cam that starts to push at an angle, and a second disc on a shaft behind it.
Model cams(int discs, double slope, double damping) {
  Model m("cams");
  m.add_node("bed");
  m.constant_speed("bed", 10.0);
  for (int i = 0; i < discs; ++i) {
    const std::string node = "disc" + std::to_string(i), before = i ? "disc" + std::to_string(i - 1) : "bed";
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = 0.1});
    m.add<ShaftSpring>("k" + node, {before, node}, {.stiffness = 2e4, .damping = damping});
    m.add<CamTorque>(
        "cam" + std::to_string(i), {node},
        {.angle_table = PeriodicTable({0.0, 0.5, 1.0, 1.1, 1.3, 1.5, 2.0, 3.0},
                                      {0.0, 0.0, -slope, -0.3 * slope, 0.4 * slope, slope, 0.0, 0.0}),
         .phase = 0.17 * i,
         .twist_feedback = true});
  }
  m.set_initial("disc0", 0.0, 3.0);
  return m;
}

}  // namespace

TEST_CASE("A kink inside a step: one disc in closed form behind it") {
  // One disc, damped by nothing; between its table's knots the motion is a vibration about a line.
  const System system = cams(1, 40.0, 0.0).build();
  constexpr double kInertia = 0.1, kStiffness = 2e4, kSpeed = 10.0;
  // Angles by straight: from 0.0 to 0.5 nothing acts, then -slope (theta - 0.5)/0.5 up to 1.0.
  const double w_0 = std::sqrt(kStiffness / kInertia);
  const auto q_0 = [&](double t) { return 3.0 / w_0 * std::sin(w_0 * t); };
  double at = 0.5 / kSpeed;  // where the angle passes 0.5
  for (int i = 0; i < 50; ++i) at -= (kSpeed * at + q_0(at) - 0.5) / (kSpeed + 3.0 * std::cos(w_0 * at));
  const double c = 80.0, w = std::sqrt((kStiffness + c) / kInertia);
  // J q'' + (k + c) q = -c (Omega t - 0.5): about q_p = -c (Omega t - 0.5)/(k + c).
  const auto line = [&](double t) { return -c * (kSpeed * t - 0.5) / (kStiffness + c); };
  const double slope = -c * kSpeed / (kStiffness + c);
  const double a = q_0(at) - line(at), b = (3.0 * std::cos(w_0 * at) - slope) / w;
  for (const double t : {at + 1e-3, at + 4e-3, 0.07}) {
    State state = State::initial(system);
    REQUIRE(propagate(system, {.tolerance = 1e-13, .t_end = t}, state).ok());
    const double phase = w * (t - at);
    CHECK(state.z[0] == Approx(line(t) + a * std::cos(phase) + b * std::sin(phase)).margin(3e-14));
    CHECK(state.v[0] == Approx(slope + w * (b * std::cos(phase) - a * std::sin(phase))).margin(1e-11));
  }
}

TEST_CASE("Kinks by a sweep: the same motion whatever else cuts the steps, and the energy closed") {
  for (const int discs : {2, 9, 40})
    for (const double damping : {0.0, 2.0}) {
      const System system = cams(discs, 40.0, damping).build();
      INFO(discs << " discs, damping " << damping);
      State whole = State::initial(system), cut = whole, coarse = whole;
      const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = 0.6}, whole);
      REQUIRE(run.ok());
      CHECK(std::abs(run.energy.relative_error()) < 1e-8);
      for (int i = 1; i <= 977; ++i) {
        cut.t = 0.6 * (i - 1) / 977;
        REQUIRE(propagate(system, {.tolerance = 1e-13, .t_start = cut.t, .t_end = 0.6 * i / 977}, cut).ok());
      }
      const double scale = whole.z.lpNorm<Eigen::Infinity>(), rate = whole.v.lpNorm<Eigen::Infinity>();
      CHECK((whole.z - cut.z).lpNorm<Eigen::Infinity>() < 2e-11 * scale);
      CHECK((whole.v - cut.v).lpNorm<Eigen::Infinity>() < 1e-10 * rate);
      // What kinks add to rows of other kinks is bounded: a loose tolerance holds, too.
      REQUIRE(propagate(system, {.tolerance = 1e-6, .t_end = 0.6}, coarse).ok());
      CHECK((coarse.z - cut.z).lpNorm<Eigen::Infinity>() < 3e-6 * scale);
    }
}

TEST_CASE("A sweep takes the place of passes: products a step of the camshaft") {
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("drive", "held");
  const System system = camshaft_entry().build(parameters).model.build();
  const RunSummary run = propagate(system, {.tolerance = 1e-9, .t_end = 0.2});
  REQUIRE(run.ok());
  // Three series a step took 54; one and a sweep of degree 20 take 40.
  CHECK(static_cast<double>(run.solves) < 46.0 * static_cast<double>(run.steps));
  CHECK(std::abs(run.energy.relative_error()) < 1e-11);
}

TEST_CASE("A mean torque alone leaves a sweep its way: order torque and applied torque cost the same") {
  const auto run = [](const auto& add_drag) {
    Model m = cams(9, 40.0, 2.0);
    add_drag(m);
    const System system = m.build();
    State state = State::initial(system);
    const RunSummary summary = propagate(system, {.tolerance = 1e-10, .t_end = 0.3}, state);
    CHECK(summary.ok());
    return std::pair{summary.solves, state};
  };
  const auto [products, state] =
      run([](Model& m) { m.add<EngineOrderTorque>("drag", {m.node_names().back()}, {.mean = -3.0}); });
  const auto [expected_products, expected] = run([](Model& m) {
    m.add<AppliedTorque>("drag", {m.node_names().back()}, {.table = TimeTable({0.0}, {-3.0})});
  });
  CHECK(products == expected_products);
  CHECK(state.z == expected.z);
  CHECK(state.v == expected.v);
}

TEST_CASE("The loss of a damped disc that swings at the fastest rate of all, in closed form") {
  // Its step is the longest there is: what few moments of the rate leave out of a loss would be 1e-7 of it.
  const double inertia = 0.2, stiffness = 800.0, damping = 2.0, turned = 0.01, t_end = 0.3;
  Model m("damped disc");
  for (const char* node : {"bed", "disc"}) m.add_node(node);
  m.constant_speed("bed", 5.0);
  m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
  m.add<ShaftSpring>("k", {"bed", "disc"}, {.stiffness = stiffness, .damping = damping});
  m.add<CamTorque>("cam", {"disc"}, {.angle_table = PeriodicTable({0.0, 1.0, 2.0}, {0.0, 0.0, 0.0})});
  m.set_initial("disc", turned, 0.0);
  const RunSummary run = propagate(m.build(), {.tolerance = 1e-10, .t_end = t_end});
  REQUIRE(run.ok());
  const double decay = damping / (2.0 * inertia), swing = std::sqrt(stiffness / inertia - decay * decay);
  const double part = std::exp(-decay * t_end), c = std::cos(swing * t_end), s = std::sin(swing * t_end);
  const double z = turned * part * (c + decay / swing * s),
               v = -turned * part * (stiffness / inertia) / swing * s;
  const double lost = 0.5 * (stiffness * (turned * turned - z * z) - inertia * v * v);
  CHECK(run.energy.dissipated == Approx(lost).epsilon(1e-9));
}

TEST_CASE("Energies of a disc that a cam moves far in each step: its balance closes as that of any other") {
  // Moments of a few powers tell the loss by the motion that a kink adds only where that is a small part of all.
  for (const double speed : {192.5, 207.1, 217.2, 278.7, 106.9})
    for (const bool feedback : {true, false}) {
      INFO(speed << " rad/s, " << (feedback ? "actual" : "nominal") << " angle");
      Model m("one disc");
      for (const char* node : {"bed", "disc"}) m.add_node(node);
      m.constant_speed("bed", speed);
      m.add<Inertia>("J", {"disc"}, {.inertia = 0.1});
      m.add<ShaftSpring>("k", {"bed", "disc"}, {.stiffness = 2e4, .damping = 15.0});
      m.add<CamTorque>("cam", {"disc"},
                       {.angle_table = PeriodicTable({0.0, 0.5, 1.0, 1.1, 1.3, 1.5, 2.0, 3.0},
                                                     {0.0, 0.0, -30.0, -9.0, 12.0, 30.0, 0.0, 0.0}),
                        .twist_feedback = feedback});
      const RunSummary run = propagate(m.build(), {.tolerance = 1e-10, .t_end = 0.5});
      INFO(run.brief_report());
      CHECK(run.ok());
      CHECK(std::abs(run.energy.relative_error()) < 1e-8);
    }
}
