// Runge-Kutta methods: stability functions on one undamped mode, order past contact changes.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <complex>

#include "tests/catch.hpp"
#include "tests/stability/amplification.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

using Complex = std::complex<double>;

/// The root of positive argument at omega h: R(i omega h).
Complex principal(const std::string& method, double omega_h) {
  Complex root = 0.0;
  for (const Complex& r : roots(amplification(method, omega_h)))
    if (r.imag() > 0.0 || root == 0.0) root = r;
  return root;
}

/// Sum of x^k/k! to the fourth power, then the method's own fifth and sixth coefficients.
Complex taylor(Complex x, double fifth, double sixth) {
  return 1.0 + x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0))) + fifth * std::pow(x, 5) +
         sixth * std::pow(x, 6);
}

}  // namespace

TEST_CASE("Explicit Runge-Kutta: stability functions and limits on the imaginary axis") {
  for (const double omega_h : {0.1, 0.5, 0.9}) {
    const Complex x(0.0, omega_h);
    INFO("omega h = " << omega_h);
    CHECK(std::abs(principal("rk4", omega_h) - taylor(x, 0.0, 0.0)) < 1e-13);
    CHECK(std::abs(principal("dormand_prince", omega_h) - taylor(x, 1.0 / 120, 1.0 / 600)) < 1e-13);
  }
  // rk4: |R|^2 = 1 - (omega h)^6/72 (1 - (omega h)^2/8), hence 2 sqrt 2.
  const double limit = 2.0 * std::sqrt(2.0);
  CHECK(spectral_radius(amplification("rk4", limit * (1 - 1e-6))) < 1.0);
  CHECK_THROWS_AS(amplification("rk4", limit * (1 + 1e-6)), ModelError);
}

TEST_CASE("tr_bdf2 is rho_inf-Bathe with 0, and has the stability function of SDIRK2") {
  // R = (1 + (1 - 2 g) x)/(1 - g x)^2, g = 1 - sqrt(1/2).
  const double g = 1.0 - std::sqrt(0.5);
  for (const double omega_h : {0.1, 1.0, 10.0, 100.0}) {
    const Complex x(0.0, omega_h);
    const Complex expected = (1.0 + (1.0 - 2.0 * g) * x) / std::pow(1.0 - g * x, 2);
    INFO("omega h = " << omega_h);
    for (const char* method : {"tr_bdf2", "bathe:0", "bathe"}) {
      const Complex root = principal(method, omega_h);
      CHECK(std::abs(root.real() - expected.real()) < 1e-12);
      CHECK(std::abs(std::abs(root.imag()) - std::abs(expected.imag())) < 1e-12);
    }
  }
}

TEST_CASE("sdirk4 damps what is too fast and is of fourth order in what is slow") {
  // Denominator (1 - x/4)^5, R(infinity) = 0 (Hairer, Wanner, IV.6).
  CHECK(spectral_radius(amplification("sdirk4", 1e4)) < 1e-2);
  CHECK(spectral_radius(amplification("sdirk4", 1e3)) < 1e-1);
  double last = 0.0;
  for (const double omega_h : {0.2, 0.1, 0.05}) {
    const double error = std::abs(principal("sdirk4", omega_h) - std::exp(Complex(0.0, omega_h))) / omega_h;
    if (last > 0.0) CHECK(std::log2(last / error) == Approx(4.0).margin(0.1));
    last = error;
  }
}

TEST_CASE("Past contact changes: fourth order with located changes, second at most without") {
  // Two masses with backlash, pulled and let go (benchmark B), to 2 s: two changes. The exact state there.
  const double exact[2] = {.088785313519524532, .17721236066731277};
  Model m("two masses");
  for (const char* node : {"1", "2"}) {
    m.add_node(node, NodeKind::translational);
    m.add<Inertia>(std::string("m_") + node, {node}, {.inertia = 10.0});
  }
  m.add<PolylineSpring>("k_1", {"1"}, PolylineSpring::dead_band(2000.0, 0.05));
  m.add<PolylineSpring>("k_2", {"1", "2"}, PolylineSpring::dead_band(1000.0, 0.03));
  m.add<AppliedTorque>("force", {"2"}, {.table = TimeTable({0.0, 1.0, 2.0, 2.0}, {0.0, 100.0, 100.0, 0.0})});
  const System system = m.build();
  const auto error = [&](const char* method, double h, bool locate) {
    State s = State::initial(system);
    const RunSummary run = simulate(system,
                                    {.scheme = step_scheme(method),
                                     .step = h,
                                     .locate_contacts = locate,
                                     .t_end = 2.0,
                                     .energy_tolerance = 1.0},
                                    s);
    CHECK(run.t_end == 2.0);
    return std::max(std::abs(s.z[0] - exact[0]), std::abs(s.z[1] - exact[1]));
  };
  for (const char* method : {"rk4", "sdirk4"}) {
    const double coarse = error(method, 0.01, true), fine = error(method, 0.0025, true);
    INFO(method << " located: " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) / 2.0 == Approx(4.0).margin(0.25));
  }
  // RK4 at 0.01 and 0.0025 in a separate program: 5.73e-6, 2.38e-8 located; 6.5e-6, 2.0e-7 without.
  CHECK(error("rk4", 0.01, true) == Approx(5.73e-6).epsilon(0.05));
  CHECK(error("rk4", 0.0025, true) == Approx(2.38e-8).epsilon(0.05));
  CHECK(error("rk4", 0.0025, false) > 1e-7);
  // Average acceleration gains nothing where the force is continuous.
  for (const bool locate : {false, true}) {
    const double coarse = error("average_acceleration", 0.01, locate);
    CHECK(coarse == Approx(1.74e-3).epsilon(0.02));
    CHECK(error("average_acceleration", 0.0025, locate) == Approx(1.115e-4).epsilon(0.02));
  }
}
