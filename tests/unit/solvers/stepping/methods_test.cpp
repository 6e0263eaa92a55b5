// Methods in time against their closed forms: linear limits, order, stability limits.
// Covers solvers/stepping/butcher_tableau.hpp, generalized_alpha.hpp, step_equation.hpp and
// step_energy.hpp through every method.
#include <drev/core/law_element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "core/dense/eigenvalues.hpp"
#include "solvers/stepping/stability_limit.hpp"
#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

namespace {

/// Amplification matrix of one step of omega h = angle on (u, v/omega), from two runs of one step.
Eigen::Matrix2d amplification(const std::string& method, double angle) {
  const System system = unit_oscillator().build();
  const double h = angle / kTwoPi;
  Eigen::Matrix2d a;
  for (int column = 0; column < 2; ++column) {
    State s = State::initial(system);
    (column == 0 ? s.z : s.v)[0] = column == 0 ? 1.0 : kTwoPi;
    simulate(system, {.scheme = step_scheme(method), .step = h, .t_end = h}, s);
    a(0, column) = s.z[0];
    a(1, column) = s.v[0] / kTwoPi;
  }
  return a;
}

double spectral_radius(const std::string& method, double angle) {
  return drev::spectral_radius(amplification(method, angle));
}

/// x'' + 0.3 x' + 2 x + 3 x^3 = p(t) with p such that x = sin t.
struct Cubic {
  ScalarResponse operator()(const ScalarInput& in) const {
    return {.y = 3 * in.x * in.x * in.x,
            .dy_dx = 9 * in.x * in.x,
            .stored_energy = 0.75 * in.x * in.x * in.x * in.x};
  }
};

System manufactured() {
  Model m("cubic");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<GroundSpring>("spring", {"m"}, {.stiffness = 2.0, .damping = 0.3});
  m.add<LawElement<Cubic>>("law", {"m"}, Cubic{});
  m.add<AppliedTorque>("load", {"m"}, {.torque = [](double t) {
                         const double s = std::sin(t);
                         return s + 0.3 * std::cos(t) + 3 * s * s * s;
                       }});
  m.set_initial("m", 0.0, 1.0);
  return m.build();
}

}  // namespace

TEST_CASE("Spectral radii of composite methods are those of the closed forms") {
  // Separate program, from the methods' stability functions; omega h of the whole step.
  const double angles[] = {0.1, 1.0, 2.0, kTwoPi, 10.0, 100.0, 1e4};
  const double rho_08[] = {.9999999221, .9993130002, .9921480945, .9012545293,
                           .8536293247, .8006816813, .8000000684};
  const double rho_0[] = {.9999996327, .9968739365, .9668145623, .6355753142,
                          .4448580600, .0482421052, .0004828427};
  for (int i = 0; i < 7; ++i) {
    INFO("omega h = " << angles[i]);
    CHECK(spectral_radius("bathe:0.8", angles[i]) == Approx(rho_08[i]).epsilon(1e-9));
    for (const char* method : {"bathe", "bathe:0", "tr_bdf2"})
      CHECK(spectral_radius(method, angles[i]) == Approx(rho_0[i]).epsilon(1e-9).margin(6e-11));
    CHECK(spectral_radius("bathe:1", angles[i]) == Approx(1.0).epsilon(1e-9));
  }
  // sdirk4: L-stable.
  CHECK(spectral_radius("sdirk4", 1e6) < 1e-4);
}

TEST_CASE("Composite methods: period elongation and amplitude decay of the closed forms") {
  struct Expected {
    const char* method;
    double h, decay, elongation;  // per period 1
  };
  for (const Expected& e : {Expected{"bathe:0.8", 0.01, 1.2154084e-6, 9.5061452e-5},
                            Expected{"bathe:0.8", 0.05, 1.5038013e-4, .0023708848},
                            Expected{"bathe:0.8", 0.1, .001165431, .0094143225},
                            Expected{"bathe:0.8", 0.2, .0082529092, .036628071},
                            Expected{"tr_bdf2", 0.01, 5.731928e-6, 1.5962523e-4},
                            Expected{"tr_bdf2", 0.05, 7.0745397e-4, .0039751997},
                            Expected{"tr_bdf2", 0.1, .0054377414, .015714424},
                            Expected{"tr_bdf2", 0.2, .037285748, .060210578}}) {
    INFO(e.method << ", h = " << e.h);
    const std::complex<double> lambda = general_eigen(amplification(e.method, kTwoPi * e.h)).values[0];
    const double phi = std::abs(std::arg(lambda));
    CHECK(kTwoPi * e.h / phi - 1 == Approx(e.elongation).epsilon(1e-7));
    CHECK(1 - std::pow(std::abs(lambda), kTwoPi / phi) == Approx(e.decay).epsilon(1e-6));
  }
}

TEST_CASE("Explicit methods: stability functions of the closed forms") {
  // 1 + x + x^2/2 + ... with the last coefficient 1/600 of Dormand and Prince's method.
  for (const double angle : {0.1, 0.7, 0.99}) {
    const std::complex<double> x(0.0, angle);
    const std::complex<double> four = 1.0 + x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0)));
    const std::complex<double> five = four + std::pow(x, 5) / 120.0 + std::pow(x, 6) / 600.0;
    CHECK(spectral_radius("rk4", angle) == Approx(std::abs(four)).epsilon(1e-12));
    CHECK(spectral_radius("dormand_prince", angle) == Approx(std::abs(five)).epsilon(1e-12));
  }
}

TEST_CASE("Every method has its order on a smooth nonlinear problem, and so has its energy balance") {
  const System system = manufactured();
  struct Expected {
    const char* method;
    double order, h;
  };
  for (const Expected& e :
       {Expected{"average_acceleration", 2, 0.05}, Expected{"generalized_alpha:0.8", 2, 0.05},
        Expected{"hht:0.1", 2, 0.05}, Expected{"bathe:0.8", 2, 0.05}, Expected{"tr_bdf2", 2, 0.05},
        Expected{"sdirk4", 4, 0.1}, Expected{"rk4", 4, 0.05}, Expected{"dormand_prince", 5, 0.05}}) {
    double last = 0.0, last_energy = 0.0;
    for (const double h : {e.h, e.h / 2, e.h / 4}) {
      State s = State::initial(system);
      const RunSummary run = simulate(system, {.scheme = step_scheme(e.method), .step = h, .t_end = 3.0}, s);
      CHECK(run.ok());
      const double error = std::max(std::abs(s.z[0] - std::sin(3.0)), std::abs(s.v[0] - std::cos(3.0)));
      const double energy = std::abs(run.energy.worst_imbalance);
      INFO(e.method << ", h = " << h << ": " << error << ", energy " << energy);
      if (last > 0.0) {
        CHECK(std::log2(last / error) == Approx(e.order).margin(0.15));
        CHECK(std::log2(last_energy / energy) > e.order - 0.3);
      }
      last = error, last_energy = energy;
    }
  }
}

TEST_CASE("Few laws or the sparse tangent: the same Runge-Kutta run") {
  const System system = manufactured();
  for (const char* method : {"bathe:0.8", "sdirk4", "rk4"}) {
    State dense = State::initial(system), sparse = dense;
    TransientOptions options{.scheme = step_scheme(method), .step = 0.05, .t_end = 3.0};
    CHECK(simulate(system, options, dense).newton_on_contacts);
    options.newton.max_dense_contacts = -1;
    CHECK_FALSE(simulate(system, options, sparse).newton_on_contacts);
    CHECK(sparse.z[0] == Approx(dense.z[0]).epsilon(1e-9));
  }
}

TEST_CASE("Steps above the stability limit are refused, and the limit is named") {
  // Chain of 10 discs, fixed at one end: omega_max = 2 sqrt(k/J) cos(pi/21).
  Model m("chain");
  for (int i = 0; i < 10; ++i) {
    const std::string node = "d" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = 0.1});
    if (i == 0)
      m.add<GroundSpring>("wall", {node}, {.stiffness = 1000.0});
    else
      m.add<ShaftSpring>("s" + node, {"d" + std::to_string(i - 1), node}, {.stiffness = 1000.0});
  }
  const System system = m.build();
  const double fastest = 197.7661652450257;
  struct Expected {
    const char* method;
    double limit;  // of omega h
  };
  for (const Expected& e :
       {Expected{"central_difference", 2.0}, Expected{"linear_acceleration", 2 * std::sqrt(3.0)},
        Expected{"newmark:0.0833333333333333333,0.5", std::sqrt(6.0)},
        Expected{"newmark:0,0.6", 1.825741858350554}, Expected{"rk4", 2 * std::sqrt(2.0)}}) {
    INFO(e.method);
    const StepScheme scheme = step_scheme(e.method);
    const double limit = e.limit / fastest;
    CHECK(stability_limit(system, scheme) == Approx(limit).epsilon(1e-9));
    CHECK_NOTHROW(simulate(system, {.scheme = scheme, .step = 0.9999 * limit, .t_end = 0.1}));
    try {
      simulate(system, {.scheme = scheme, .step = 1.0001 * limit, .t_end = 0.1});
      FAIL("a step above the limit");
    } catch (const ModelError& error) {
      CHECK(std::string(error.what()).find("stability limit of " + scheme.name) != std::string::npos);
    }
  }
  for (const char* method : {"average_acceleration", "generalized_alpha:0.8", "hht", "bathe", "sdirk4"})
    CHECK(std::isinf(stability_limit(system, step_scheme(method))));
  // The limit is sharp: the fastest mode of a run at it neither grows nor, for rk4, decays.
  CHECK(spectral_radius("rk4", 2 * std::sqrt(2.0)) == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Damping in a stability limit: explicit Runge-Kutta on the real axis") {
  // A disc with a dashpot alone: lambda = -d/J; rk4 is stable to 2.785293563405282.
  Model m("disc");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  m.add<GroundSpring>("wall", {"disc"}, {.stiffness = 1e-6, .damping = 50.0});
  CHECK(stability_limit(m.build(), step_scheme("rk4")) == Approx(2.785293563405282 / 25.0).epsilon(1e-8));
}
