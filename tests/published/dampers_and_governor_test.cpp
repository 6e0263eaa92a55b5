/// Dampers, couplings, the governor's actuator and planetary sets beside closed forms and separate programs (numpy):
///
/// - tuned viscous damper: Den Hartog's fixed points and Brock's damping; minimax by a minimiser, which the closed form of
///   Nishihara and Asami reproduces;
/// - coupling whose stiffness and loss follow the amplitude: equivalent linear solution, a single root each;
/// - Maxwell branch: its complex stiffness in closed form;
/// - PI governor with an actuator's lag: roots of the cubic;
/// - planetary set with translating bodies: J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316, tables 1 and 2; its
///   purely torsional limit.
#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>
#include <complex>

#include "tests/catch.hpp"

using namespace drev;

namespace {

const SweepSection& section_of(const LinearSweep& sweep, const std::string& name) {
  for (const SweepSection& section : sweep.sections)
    if (section.name == name) return section;
  throw std::runtime_error("no section " + name);
}

/// J = 2, K = 8e4 (w_n = 200 rad/s) on a clock, 100 N m of order 1, and a spring and oil damper on it; torques of the
/// shaft over 100 N m at these g = w/w_n, and the largest of all.
struct Response {
  std::vector<double> at;
  double largest = 0.0;
};
Response tuned_disc(double mu, double f, double ratio, const std::vector<double>& at, bool peaks) {
  Model m("disc with damper");
  m.add_node("clock"), m.add_node("disc");
  m.constant_speed("clock", 200.0);
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 8e4});
  m.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  m.add<TorsionalDamper>(
      "damper", {"disc"},
      {.ring_inertia = 2.0 * mu, .natural_frequency = f * 200.0 / kTwoPi, .damping_ratio = ratio});
  m.add<EngineOrderTorque>("torque", {"disc"}, {.harmonics = {{1.0, 100.0, 0.0}}, .twist_feedback = false});
  const System system = m.build();
  Response r;
  if (!at.empty()) {
    std::vector<double> speeds;
    for (const double g : at) speeds.push_back(200.0 * g);
    const LinearSweep sweep = sweep_linear(system, {.speeds = speeds, .orders = {1.0}, .refine = false});
    for (std::size_t i = 0; i < at.size(); ++i)
      r.at.push_back(section_of(sweep, "shaft.torque_Nm").half_range()[Eigen::Index(i)] / 100.0);
  }
  if (!peaks) return r;
  std::vector<double> speeds;
  for (double w = 130.0; w <= 240.0; w += 2.0) speeds.push_back(w);
  const LinearSweep sweep = sweep_linear(system, {.speeds = speeds, .orders = {1.0}});
  for (const SweepPeak& peak : sweep.peaks)
    if (sweep.sections[std::size_t(peak.section)].name == "shaft.torque_Nm")
      r.largest = std::max(r.largest, peak.half_range / 100.0);
  return r;
}

}  // namespace

TEST_CASE("Tuned viscous damper: fixed points, Brock's damping, minimax", "[train_elements]") {
  struct Row {
    double mu, f, zeta, g_1, g_2, height, peak, best_f, best_zeta, best_peak;
  };
  for (const Row& r : {Row{.05, .952380952, .127267258, .89646195, 1.04934164, 6.403124237, 6.408443170,
                           .952372044, .133937726, 6.407920768},
                       Row{.1, .909090909, .167852033, .84303678, 1.05236439, 4.582575695, 4.590220175,
                           .909058293, .185469836, 4.589165566},
                       Row{.2, .833333333, .208333333, .76293766, 1.04143785, 3.316624790, 3.327539404,
                           .833222991, .252173444, 3.325438841}}) {
    INFO(r.mu);
    const double f = 1.0 / (1.0 + r.mu), by_ring = r.zeta / f;  // c/(2 m_d w_n) over c/(2 m_d w_d)
    CHECK(f == Approx(r.f).epsilon(1e-9));
    // The same height whatever the damping.
    for (const double damping : {0.3 * by_ring, by_ring, 4.0 * by_ring})
      for (const double height : tuned_disc(r.mu, f, damping, {r.g_1, r.g_2}, false).at)
        CHECK(height == Approx(r.height).epsilon(2e-7));  // eight digits of g are given
    CHECK(
        tuned_disc(r.mu, f, std::sqrt(3.0 * r.mu / (8.0 * std::pow(1.0 + r.mu, 3))) / f, {}, true).largest ==
        Approx(r.peak).epsilon(2e-9));
    CHECK(tuned_disc(r.mu, r.best_f, r.best_zeta, {}, true).largest == Approx(r.best_peak).epsilon(1e-8));
  }
}

namespace {

/// J 10 and 4 with a coupling between; torques of order 2 (and more) on the first and of a square law on the second.
System two_masses_coupled(ElasticCoupling::Params coupling, double speed, std::vector<Harmonic> torque) {
  Model m("two masses");
  m.add_node("a"), m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 10.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 4.0});
  m.add<ElasticCoupling>("coupling", {"a", "b"}, std::move(coupling));
  m.add<EngineOrderTorque>("torque", {"a"}, {.harmonics = std::move(torque), .twist_feedback = false});
  m.set_reference("a", constant_speed(speed));
  return m.build();
}

}  // namespace

TEST_CASE("Coupling whose stiffness and loss follow the amplitude: equivalent linear solution",
          "[train_elements]") {
  // k = 2e5 (1 - 20 A), eta = 0.05 + 30 A.
  const ElasticCoupling::Params coupling{
      .material = {.by_amplitude = {{0.0, 3e-3}, {2e5, 2e5 * 0.94}, {0.05, 0.14}},
                   .lowest_frequency = 30,
                   .highest_frequency = 60}};
  const double w_0 = 264.575131106459;
  std::vector<double> speeds;
  for (const double factor : {.8, .9, .95, .98, 1.0, 1.1}) speeds.push_back(0.5 * factor * w_0);
  const System system = two_masses_coupled(coupling, 0.5 * w_0, {{2.0, 100.0, 0.4}});
  const LinearSweep sweep =
      sweep_linear(system, {.speeds = speeds, .orders = {2.0}, .refine = false, .threads = 1});
  const SweepSection& section = section_of(sweep, "coupling.torque_Nm");
  const std::vector<double> twists{3.997837797e-4, 7.560077332e-4, 1.273799191e-3,
                                   1.529658641e-3, 1.482632928e-3, 6.148384729e-4},
      torques{79.469718, 149.30815, 249.23369, 297.93265, 289.01513, 121.73975};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    CHECK(std::abs(section.twist(0, Eigen::Index(i))) == Approx(twists[i]).epsilon(2e-9));
    CHECK(std::abs(section.amplitude(0, Eigen::Index(i))) == Approx(torques[i]).epsilon(5e-8));
    CHECK(sweep.input_power[Eigen::Index(i)] ==
          Approx(sweep.dissipated_power[Eigen::Index(i)]).epsilon(1e-9));
  }
  // Two orders: the amplitude is the root of the sum of squares; a coupling that stands there is the same.
  const std::vector<Harmonic> torque{{2.0, 60.0, 0.4}, {2.5, 30.0, 0.0}};
  const LinearSweep both = sweep_linear(two_masses_coupled(coupling, 0.5 * w_0, torque),
                                        {.speeds = {0.45 * w_0}, .orders = {2.0, 2.5}, .refine = false});
  const SweepSection& follows = section_of(both, "coupling.torque_Nm");
  const double a = std::hypot(std::abs(follows.twist(0, 0)), std::abs(follows.twist(1, 0)));
  const ElasticCoupling::Params fixed{.material = {.stiffness = 2e5 * (1.0 - 20.0 * a),
                                                   .loss_factor = 0.05 + 30.0 * a,
                                                   .lowest_frequency = 30,
                                                   .highest_frequency = 60}};
  const LinearSweep same = sweep_linear(two_masses_coupled(fixed, 0.5 * w_0, torque),
                                        {.speeds = {0.45 * w_0}, .orders = {2.0, 2.5}, .refine = false});
  for (const Eigen::Index k : {0, 1})
    CHECK(std::abs(follows.twist(k, 0)) ==
          Approx(std::abs(section_of(same, "coupling.torque_Nm").twist(k, 0))).epsilon(1e-10));
  CHECK(a > 1e-4);
  // In time it stands at the amplitude that it is given.
  const ViscoelasticStiffness at(ViscoelasticStiffness::Params{.by_amplitude = coupling.material.by_amplitude,
                                                               .at_amplitude = 1.5e-3,
                                                               .lowest_frequency = 30,
                                                               .highest_frequency = 60});
  CHECK(at.at(250.0).real() == Approx(2e5 * 0.97));
  CHECK(at.at(250.0).imag() == Approx(2e5 * 0.97 * 0.095));
}

TEST_CASE("Where several amplitudes of a coupling satisfy its table the largest is taken, and it is said",
          "[train_elements]") {
  // k = 400 to 100, eta = 0.1 to 0.2 over 0 to 0.1 rad, J = 10 and 4, torque p on the first: x_o = p mu/10 / (k* - mu (o w)^2),
  // mu = 40/14.
  constexpr double mu = 40.0 / 14.0, torque = 20.0;
  const ElasticCoupling::Params coupling{
      .material = {.by_amplitude = {{0.0, 0.1}, {400.0, 100.0}, {0.1, 0.2}},
                   .lowest_frequency = 1,
                   .highest_frequency = 2,
                   .permitted_error = 0.99}};
  const auto response = [&](double a, double w) {
    const double part = std::min(a / 0.1, 1.0), k = 400.0 - 300.0 * part, eta = 0.1 + 0.1 * part;
    double square = 0.0;
    for (const double order : {1.0, 2.0})
      square +=
          std::norm(torque * mu / 10.0 / (k * std::complex<double>(1.0, eta) - mu * order * order * w * w));
    return std::sqrt(square);
  };
  std::vector<double> speeds;
  for (double w = 2.0; w < 13.0; w += 0.5) speeds.push_back(w);
  const System system = two_masses_coupled(coupling, 5.0, {{1.0, torque, 0.0}, {2.0, torque, 0.0}});
  const LinearSweep sweep = sweep_linear(system, {.speeds = speeds, .orders = {1.0, 2.0}, .refine = false});
  const SweepSection& section = section_of(sweep, "coupling.torque_Nm");
  int ambiguous = 0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    INFO(speeds[i] << " rad/s");
    const auto at = static_cast<Eigen::Index>(i);
    const double found = std::hypot(std::abs(section.twist(0, at)), std::abs(section.twist(1, at)));
    CHECK(response(found, speeds[i]) == Approx(found).epsilon(1e-9));
    int solutions = 0;
    double largest = 0.0;
    for (double a = 1e-4; a < 2.0; a += 1e-4)
      if ((response(a, speeds[i]) > a) != (response(a + 1e-4, speeds[i]) > a + 1e-4))
        ++solutions, largest = a;
    CHECK(found == Approx(largest + 0.5e-4).margin(1e-4));
    CHECK((solutions > 1) == (sweep.several_amplitudes[i] != 0));
    ambiguous += solutions > 1 ? 1 : 0;
  }
  CHECK(ambiguous > 3);
  CHECK(ambiguous < static_cast<int>(speeds.size()));
}

TEST_CASE("Couplings whose stiffness follows mean torque and amplitude, two of them: each is what it carries",
          "[train_elements]") {
  // The propeller takes Q (w/w_0)^2 through both couplings; the engine's mean torque is balanced at the first node.
  const ViscoelasticStiffness::Params progressive{
      .by_mean_torque = {{0.0, 500.0, 1000.0}, {1e5, 1.5e5, 2.5e5}, {0.10, 0.12, 0.12}},
      .by_amplitude = {{0.0, 4e-3}, {1e5, 0.8e5}, {0.10, 0.15}},
      .lowest_frequency = 15,
      .highest_frequency = 60};
  const auto build = [](const ViscoelasticStiffness::Params& first,
                        const ViscoelasticStiffness::Params& second, double speed) {
    Model m("plant");
    for (const char* n : {"engine", "gearbox", "propeller"}) m.add_node(n);
    m.add<Inertia>("J_engine", {"engine"}, {.inertia = 10.0});
    m.add<Inertia>("J_gearbox", {"gearbox"}, {.inertia = 2.0});
    m.add<Inertia>("J_propeller", {"propeller"}, {.inertia = 6.0});
    m.add<ElasticCoupling>("one", {"engine", "gearbox"}, {.material = first});
    m.add<ElasticCoupling>("two", {"gearbox", "propeller"}, {.material = second});
    m.add<EngineOrderTorque>("gas", {"engine"}, {.harmonics = {{1.5, 150.0, 0.0}}, .twist_feedback = false});
    m.add<Propeller>("water", {"propeller"}, {.rated_torque = 900.0, .rated_speed = 150.0});
    m.set_reference("engine", constant_speed(speed));
    return m.build();
  };
  const std::vector<double> speeds{80.0, 110.0, 150.0};
  const LinearSweep sweep =
      sweep_linear(build(progressive, progressive, 150.0),
                   {.speeds = speeds, .orders = {1.5}, .refine = false, .threads = 1, .balance = "engine"});
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const auto at = Eigen::Index(i);
    INFO(speeds[i]);
    const double torque = 900.0 * speeds[i] * speeds[i] / 22500.0;  // Q (w/w_0)^2
    const double part = torque < 500.0 ? torque / 500.0 : torque / 500.0 - 1.0;
    const double k_m = torque < 500.0 ? 1e5 + 0.5e5 * part : 1.5e5 + 1e5 * part,
                 eta_m = torque < 500.0 ? 0.10 + 0.02 * part : 0.12;
    const auto standing = [&](const std::string& name) {
      const double a = std::abs(section_of(sweep, name).twist(0, at));
      CHECK(std::abs(section_of(sweep, name).mean[at]) == Approx(torque).epsilon(1e-9));
      return ViscoelasticStiffness::Params{.stiffness = k_m * (1.0 - 0.2 * a / 4e-3),
                                           .loss_factor = eta_m * (1.0 + 0.5 * a / 4e-3),
                                           .lowest_frequency = 15,
                                           .highest_frequency = 60};
    };
    const LinearSweep same = sweep_linear(
        build(standing("one.torque_Nm"), standing("two.torque_Nm"), 150.0),
        {.speeds = {speeds[i]}, .orders = {1.5}, .refine = false, .threads = 1, .balance = "engine"});
    for (const char* name : {"one.torque_Nm", "two.torque_Nm"}) {
      CHECK(std::abs(section_of(same, name).amplitude(0, 0)) ==
            Approx(std::abs(section_of(sweep, name).amplitude(0, at))).epsilon(1e-9));
      CHECK(section_of(same, name).heat[0] == Approx(section_of(sweep, name).heat[at]).epsilon(1e-9));
    }
  }
}

TEST_CASE("Maxwell branch beside a spring: torque and heat", "[train_elements]") {
  for (const auto& [omega, torque, heat] : {std::tuple{100.0, 33.1772835, .02524615},
                                            {250.0, 110.940039, 1.23076923},
                                            {400.0, 31.1849163, .159426066}}) {
    Model m("two masses");
    m.add_node("a"), m.add_node("b"), m.add_node("inner");
    m.add<Inertia>("J_a", {"a"}, {.inertia = 10.0});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 4.0});
    m.add<Inertia>("J_inner", {"inner"}, {.inertia = 1e-9});  // 2e-9 of the branch's stiffness at most
    m.add<ShaftSpring>("spring", {"a", "b"}, {.stiffness = 2e5});
    m.add<ShaftSpring>("branch", {"a", "inner"}, {.stiffness = 1e5});
    m.add<Dashpot>("dashpot", {"inner", "b"}, {.damping = 200.0});
    m.add<EngineOrderTorque>("torque", {"a"}, {.harmonics = {{2.0, 100.0, 0.4}}, .twist_feedback = false});
    m.set_reference("a", constant_speed(0.5 * omega));
    const LinearSweep sweep =
        sweep_linear(m.build(), {.speeds = {0.5 * omega}, .orders = {2.0}, .refine = false, .threads = 1});
    const std::complex<double> both = section_of(sweep, "spring.torque_Nm").amplitude(0, 0) +
                                      section_of(sweep, "branch.torque_Nm").amplitude(0, 0);
    CHECK(std::abs(both) == Approx(torque).epsilon(1e-8));
    CHECK(sweep.dissipated_power[0] == Approx(heat).epsilon(2e-7));  // eight digits are given
    CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-9));
  }
}

TEST_CASE("Speed governor with an actuator's lag: load step, poles", "[train_elements]") {
  Model m("set");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 120.0});
  m.add<SpeedGovernor>("governor", {"rotor"},
                       {.proportional_gain = 600.0, .integral_gain = 1500.0, .actuator_lag = 0.08});
  m.add<AppliedTorque>("load", {"rotor"}, {.table = TimeTable({0.0}, {-900.0})});
  m.set_reference("rotor", constant_speed(rpm(1500.0)));
  const System system = m.build();
  Peaks peaks(find_channels(system, {"rotor.speed_rad_per_s"}));
  Recorder seconds(system, {"rotor.speed_rad_per_s"}, 1.0);
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = 2.0}, {&peaks, &seconds});
  CHECK(run.ok());
  CHECK(peaks.peaks()[0].min == Approx(-1.251867233).epsilon(2e-9));
  CHECK(peaks.peaks()[0].min_time == Approx(.299629355).epsilon(1e-6));
  CHECK(seconds.samples(0)[1] == Approx(.0568135864).epsilon(2e-9));
  CHECK(seconds.samples(0)[2] == Approx(-.00901105246).epsilon(5e-9));
  const DampedModeSet damped = solve_damped_modes(system, {});
  REQUIRE(!damped.modes.empty());
  CHECK(std::abs(damped.modes[0].lambda - std::complex<double>(-2.93671351, 3.86717222)) < 2e-8);
  double nearest = 1e9;
  for (const double pole : damped.real_lambda) nearest = std::min(nearest, std::abs(pole + 6.62657298));
  CHECK(nearest < 2e-8);
}

TEST_CASE("Governor's lag: slow integral or fast, the same transfer function", "[train_elements]") {
  // (K_p s + K_i)/(1 + T s) seen from the node, where K_p > K_i T, < and =.
  for (const double integral : {100.0, 5000.0, 600.0 / 0.2}) {
    const SpeedGovernor governor(
        {.proportional_gain = 600.0, .integral_gain = integral, .actuator_lag = 0.2});
    Terms terms(2);
    governor.describe(2, terms);
    for (const double w : {0.5, 7.0, 90.0}) {
      const std::complex<double> s(0.0, w);
      const Eigen::Matrix2cd d = terms.mass.cast<std::complex<double>>() * s * s +
                                 terms.deviation_damping.cast<std::complex<double>>() * s +
                                 terms.stiffness.cast<std::complex<double>>();
      const std::complex<double> seen = d(0, 0) - d(0, 1) * d(1, 0) / d(1, 1);
      const std::complex<double> expected = (600.0 * s + integral) / (1.0 + 0.2 * s);
      CHECK(std::abs(seen - expected) < 1e-12 * std::abs(expected));
    }
  }
}

namespace {

/// A spring along a line on which several nodes move: force k sum a_i q_i, on node i a_i times that.
class LineSpring final : public Element {
 public:
  struct Params {
    std::vector<double> arms;
    double stiffness;
  };
  explicit LineSpring(Params p) : params_(std::move(p)) {}
  std::string_view type() const override { return "spring along a line"; }
  int min_nodes() const override { return static_cast<int>(params_.arms.size()); }
  void check(ParameterCheck& /*check*/) const override {}
  void describe(int nodes, Terms& terms) const override {
    const Eigen::Map<const Eigen::VectorXd> a(params_.arms.data(), nodes);
    terms.stiffness = params_.stiffness * a * a.transpose();
    terms.speed_ratio_constraints.push_back({.b = a});
  }

 private:
  Params params_;
};

/// Lin and Parker's plane model: x, y and u = r theta of sun, ring, carrier; radial, tangential, u of each planet. All
/// nodes are translational here: u is a length, and I/r^2 its mass. At rest: no gyroscopic terms.
System plane_planets(int planets) {
  Model m("planetary gear");
  const double mesh = 5e8, bearing = 1e8, pressure = deg(24.6);
  const auto body = [&](const std::string& name, double mass, double inertia) {
    for (const char* axis : {"_x", "_y", "_u"}) {
      m.add_node(name + axis, NodeKind::translational);
      m.add<Inertia>("m_" + name + axis, {name + axis}, {.inertia = axis[1] == 'u' ? inertia : mass});
    }
  };
  body("sun", 0.4, 0.39), body("ring", 2.35, 3.0), body("carrier", 5.43, 6.29);
  for (const char* name : {"sun", "ring", "carrier"})
    for (const char* axis : {"_x", "_y"})
      m.add<GroundSpring>(std::string("bearing_") + name + axis, {std::string(name) + axis},
                          {.stiffness = bearing});
  m.add<GroundSpring>("ring_torsion", {"ring_u"}, {.stiffness = 1e9});
  for (int n = 0; n < planets; ++n) {
    const std::string p = "planet_" + std::to_string(n + 1);
    body(p, 0.66, 0.61);  // _x radial, _y tangential
    const double psi = kTwoPi * n / planets, s = psi - pressure, r = psi + pressure;
    m.add<LineSpring>(
        "sun_" + p, {"sun_x", "sun_y", "sun_u", p + "_x", p + "_y", p + "_u"},
        {{-std::sin(s), std::cos(s), 1.0, -std::sin(pressure), -std::cos(pressure), 1.0}, mesh});
    m.add<LineSpring>(
        "ring_" + p, {"ring_x", "ring_y", "ring_u", p + "_x", p + "_y", p + "_u"},
        {{-std::sin(r), std::cos(r), 1.0, std::sin(pressure), -std::cos(pressure), -1.0}, mesh});
    m.add<LineSpring>("radial_" + p, {"carrier_x", "carrier_y", p + "_x"},
                      {{std::cos(psi), std::sin(psi), -1.0}, bearing});
    m.add<LineSpring>("tangential_" + p, {"carrier_x", "carrier_y", "carrier_u", p + "_y"},
                      {{-std::sin(psi), std::cos(psi), 1.0, -1.0}, bearing});
  }
  return m.build();
}

}  // namespace

TEST_CASE("Planetary gear with translating bodies: rotational modes of a published table",
          "[train_elements]") {
  const std::vector<std::vector<double>> expected{
      {1475.747230, 1930.346570, 2658.324424, 7462.803434, 11775.265785},
      {1536.535497, 1970.592397, 2625.650190, 7773.551321, 13071.110239},
      {1567.397659, 2006.078476, 2614.795689, 8065.389946, 14253.092354}};
  // Printed, to .1 Hz; that of 4 planets which is off is 1536.6.
  const std::vector<std::vector<double>> printed{{1475.7, 1930.3, 2658.3, 7462.8, 11775.3},
                                                 {1536.6, 1970.6, 2625.7, 7773.6, 13071.1},
                                                 {1567.4, 2006.1, 2614.8, 8065.4, 14253.1}};
  for (int planets = 3; planets <= 5; ++planets) {
    const System system = plane_planets(planets);
    const ModeSet modes = solve_modes(system, {.count = 9 + 3 * planets - 1});
    const auto row = std::size_t(planets - 3);
    for (std::size_t k = 0; k < 5; ++k) {
      double nearest = 1e9, found = 0.0;
      for (std::size_t i = 0; i < modes.frequency_Hz.size(); ++i)
        if (const double f = modes.frequency_Hz[i]; std::abs(f - expected[row][k]) < nearest)
          nearest = std::abs(f - expected[row][k]), found = f;
      INFO(planets << " planets, " << found);
      CHECK(found == Approx(expected[row][k]).epsilon(2e-9));
      CHECK(std::abs(found - printed[row][k]) < 0.07);
    }
  }
}

TEST_CASE("Planetary gear, purely torsional: the limit of rigid bearings by gear meshes",
          "[train_elements]") {
  // Meshes u_s + u_p - u_c cos(a) and u_r - u_p - u_c cos(a), by radii 1, 1 and 3 and a carrier angle u_c cos(a)/2.
  const double cosine = std::cos(deg(24.6));
  for (const bool ring_fixed : {false, true}) {
    Model m("planetary gear");
    for (const char* node : {"sun", "ring", "carrier"}) m.add_node(node);
    m.add<Inertia>("J_sun", {"sun"}, {.inertia = 0.39});
    m.add<Inertia>("J_ring", {"ring"}, {.inertia = 9.0 * 3.0});
    m.add<Inertia>("J_carrier", {"carrier"}, {.inertia = (6.29 + 3.0 * 0.66) * 4.0 / (cosine * cosine)});
    if (ring_fixed)
      m.hold("ring");
    else
      m.add<GroundSpring>("ring_torsion", {"ring"}, {.stiffness = 9e9});
    for (int n = 1; n <= 3; ++n) {
      const std::string p = "planet_" + std::to_string(n);
      m.add_node(p);
      m.add<Inertia>("J_" + p, {p}, {.inertia = 0.61});
      m.add<GearMesh>("sun_" + p, {"sun", p, "carrier"},
                      {.base_radius_1 = 1.0, .base_radius_2 = 1.0, .stiffness = 5e8});
      m.add<GearMesh>("ring_" + p, {p, "ring", "carrier"},
                      {.base_radius_1 = 1.0, .base_radius_2 = 3.0, .internal = true, .stiffness = 5e8});
    }
    const System system = m.build();
    const std::vector<double> expected =
        ring_fixed ? std::vector<double>{4657.391, 6443.995287, 6443.995287, 11173.83}
                   : std::vector<double>{2206.154, 6123.712, 6443.995287, 6443.995287, 11193.18};
    const ModeSet modes = solve_modes(system, {.count = static_cast<int>(expected.size())});
    CHECK(modes.rigid_modes == 1);
    for (std::size_t i = 0; i < expected.size(); ++i)
      CHECK(modes.frequency_Hz[i] == Approx(expected[i]).epsilon(4e-7));
  }
}
