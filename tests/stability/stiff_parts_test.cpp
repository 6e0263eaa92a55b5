// A stiff part that matters only as a constraint, and motions that are given: what becomes of the
// rates and accelerations there.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <Eigen/Dense>
#include <cmath>

#include "core/dense/eigenvalues.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Base u_1 = sin 1.2 t - k_1 = 1e7 - mass 2 - k_2 = 1 - mass 3, from rest. K. J. Bathe, G. Noh, Insight into
/// an implicit time integration scheme for structural dynamics, Computers and Structures 98-99, 2012.
constexpr double kStiff = 1e7, kForcing = 1.2;

System stiff_and_soft() {
  Model m("stiff and soft");
  for (const char* node : {"1", "2", "3"}) m.add_node(node, NodeKind::translational);
  for (const char* node : {"2", "3"}) m.add<Inertia>(std::string("m_") + node, {node}, {.inertia = 1.0});
  m.add<ShaftSpring>("k_1", {"1", "2"}, {.stiffness = kStiff});
  m.add<ShaftSpring>("k_2", {"2", "3"}, {.stiffness = 1.0});
  m.given_motion("1", {[](double t) {
                         return MotionPoint{std::sin(kForcing * t), kForcing * std::cos(kForcing * t),
                                            -kForcing * kForcing * std::sin(kForcing * t)};
                       },
                       {}});
  return m.build();
}

/// The exact motion without the stiff spring's own vibration: forced part and slow mode.
struct Slow {
  Slow() {
    Eigen::Matrix2d k;
    k << kStiff + 1.0, -1.0, -1.0, 1.0;
    const SymmetricEigen modes = symmetric_eigen(k);
    const Eigen::Matrix2d dynamic = k - kForcing * kForcing * Eigen::Matrix2d::Identity();
    forced = dynamic.inverse() * Eigen::Vector2d(kStiff, 0.0);
    omega = 0.999999949999999;
    const Eigen::Vector2d shape = modes.vectors.col(0);
    free = -kForcing / omega * shape.dot(forced) * shape;
  }
  Eigen::Vector2d u(double t) const { return forced * std::sin(kForcing * t) + free * std::sin(omega * t); }
  Eigen::Vector2d v(double t) const {
    return forced * kForcing * std::cos(kForcing * t) + free * omega * std::cos(omega * t);
  }
  Eigen::Vector2d a(double t) const {
    return -forced * kForcing * kForcing * std::sin(kForcing * t) -
           free * omega * omega * std::sin(omega * t);
  }
  Eigen::Vector2d forced, free;
  double omega;
};

}  // namespace

TEST_CASE("Stiff and soft: the reference is the published one's") {
  const Slow slow;
  const double expected[3][5] = {{1, .93203914464195, .17665012544915, .43482937303482, .48530328294362},
                                 {5, -.27941570851447, -1.9802126448076, 1.1522042101752, -1.8450224438559},
                                 {10, -.53657296803052, -.26420885053395, 1.0126243360548, -4.589796584907}};
  for (const auto& e : expected) {
    CHECK(slow.u(e[0])[0] == Approx(e[1]).margin(1e-11));
    CHECK(slow.u(e[0])[1] == Approx(e[2]).margin(1e-11));
    CHECK(slow.v(e[0])[0] == Approx(e[3]).margin(1e-11));
  }
}

TEST_CASE("Stiff and soft at 24 steps a period: average acceleration fails, methods that damp hold") {
  const Slow slow;
  const System system = stiff_and_soft();
  const double h = 0.2618;
  struct Row {
    const char* method;
    double v, a;  // largest errors at mass 2 from the 20th step on
  };
  for (const Row& row : {Row{"average_acceleration", 1.21323, 698.547},
                         {"hht:0.05", .4798, 49.97},
                         {"generalized_alpha:0.8", .0732, 4.242},
                         {"generalized_alpha:0", .0391, .445},
                         {"bathe:0.8", .00856, 17.8},
                         {"bathe:0", .00811, .146}}) {
    Recorder r(system, {"2.velocity_m_per_s", "2.acceleration_m_per_s2"}, h);
    simulate(system, {.scheme = step_scheme(row.method), .step = h, .t_end = 38 * h, .energy_tolerance = 1e9},
             {&r});
    double v = 0.0, a = 0.0;
    for (std::size_t i = 20; i < r.times().size(); ++i) {
      v = std::max(v, std::abs(r.samples(0)[i] - slow.v(r.times()[i])[0]));
      a = std::max(a, std::abs(r.samples(1)[i] - slow.a(r.times()[i])[0]));
    }
    INFO(row.method);
    CHECK(v == Approx(row.v).epsilon(2e-3));
    CHECK(a == Approx(row.a).epsilon(5e-3));
  }
}

TEST_CASE("Given motion: accelerations and reactions do not drift, whatever the method") {
  // Average acceleration with a multiplier (index 3) makes an acceleration error of t |u'''|/3 that no step
  // removes: 3.33 at t = 10 here. Known motions are eliminated instead: their acceleration is the one given,
  // and the reaction errs by the free disc's error alone, of second order.
  Model m("base");
  m.add_node("base");
  m.add_node("disc");
  m.add<Inertia>("J_b", {"base"}, {.inertia = 1.0});
  m.add<Inertia>("J_d", {"disc"}, {.inertia = 1.0});
  m.add<ShaftSpring>("k", {"base", "disc"}, {.stiffness = 9.0});
  m.given_motion("base", {[](double t) { return MotionPoint{std::sin(t), std::cos(t), -std::sin(t)}; }, {}});
  const System system = m.build();
  // q'' + 9 q = 9 sin t from rest: q = 9/8 sin t - 3/8 sin 3 t.
  const auto reaction = [](double t) {
    return -std::sin(t) + 9.0 * (std::sin(t) - 9.0 / 8.0 * std::sin(t) + 3.0 / 8.0 * std::sin(3 * t));
  };
  for (const char* method : {"average_acceleration", "hht:0.05", "generalized_alpha:0.8",
                             "generalized_alpha:0", "bathe", "tr_bdf2"}) {
    double last = 0.0;
    for (const double h : {0.01, 0.005}) {
      Recorder r(system, {"base.acceleration_rad_per_s2", "base.reaction_Nm"}, 0.1);
      simulate(system, {.scheme = step_scheme(method), .step = h, .t_end = 10.0, .energy_tolerance = 1.0},
               {&r});
      double a = 0.0, error = 0.0;
      for (std::size_t i = 0; i < r.times().size(); ++i) {
        const double t = r.times()[i];
        a = std::max(a, std::abs(r.samples(0)[i] + std::sin(t)));
        error = std::max(error, std::abs(r.samples(1)[i] - reaction(t)));
      }
      INFO(method << ", h = " << h << ": " << error);
      CHECK(a < 1e-14);
      CHECK(error < 0.04);
      if (last > 0.0) CHECK(std::log2(last / error) == Approx(2.0).margin(0.05));
      last = error;
    }
  }
}
