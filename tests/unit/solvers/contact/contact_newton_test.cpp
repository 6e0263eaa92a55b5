// Newton at dead zones. The minimal example that cycles: ground - m1 - m2 - m3 in a chain of three gaps,
// A = diag(5, 1, 200), k = (500, 200, 50), half gaps (0.1, 0.1, 0.5), P = (8, -2, -5).
// Covers solvers/contact/newton_options.hpp, newton_result.hpp and line_search.hpp with the
// iteration that uses them.
#include "solvers/contact/contact_newton.hpp"

#include <drev/core/law_element.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <random>

#include "solvers/contact/sparse_newton.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

struct GapChain {
  std::vector<double> ground, stiffness, half_gap, load;
};

System build(const GapChain& c) {
  Model m("chain of gaps");
  std::string last;
  for (std::size_t i = 0; i < c.ground.size(); ++i) {
    const std::string n = std::to_string(i + 1), node = "m" + n;
    m.add_node(node);
    m.add<Inertia>("J" + n, {node}, {.inertia = 1.0});
    if (c.ground[i] > 0.0) m.add<GroundSpring>("ground" + n, {node}, {.stiffness = c.ground[i]});
    const auto gap = PolylineSpring::dead_band(c.stiffness[i], c.half_gap[i]);
    if (last.empty())
      m.add<PolylineSpring>("gap" + n, {node}, gap);
    else
      m.add<PolylineSpring>("gap" + n, {last, node}, gap);
    const double p = c.load[i];
    m.add<AppliedTorque>("load" + n, {node}, {.torque = [p](double) { return p; }});
    last = node;
  }
  return m.build();
}

const GapChain kCycles{{5, 1, 200}, {500, 200, 50}, {0.1, 0.1, 0.5}, {8, -2, -5}};
const double kRoot[3] = {0.11088933680743326, 0.0008849122462022629, -0.025};

/// The same static problem on the contact forces: S = A, x_free = B' A^-1 P, G = B' A^-1 B.
NewtonResult solve_on_contacts(const System& system, const GapChain& c, bool line_search, Vector& u) {
  const auto n = static_cast<Eigen::Index>(c.ground.size());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    b(j, j) = 1.0;
    if (j > 0) b(j - 1, j) = -1.0;
  }
  const Vector a = Eigen::Map<const Vector>(c.ground.data(), n);
  const Vector p = Eigen::Map<const Vector>(c.load.data(), n);
  const Eigen::MatrixXd w = a.cwiseInverse().asDiagonal() * b;
  const Vector free = b.transpose() * p.cwiseQuotient(a);
  std::vector<ScalarInput> inputs(static_cast<std::size_t>(n));
  for (std::size_t j = 0; j < inputs.size(); ++j) inputs[j].x = free[static_cast<Eigen::Index>(j)];
  ContactNewton newton(system, b.transpose() * w, 1.0, 0.0);
  Vector lambda = Vector::Zero(n);
  const NewtonResult result =
      newton.solve(inputs, 10.0, {.max_iterations = 200, .line_search = line_search}, lambda);
  u = p.cwiseQuotient(a) - w * lambda;
  return result;
}

NewtonResult solve_sparse(const System& system, bool line_search, Vector& u) {
  const Assembler assembler(system);
  const Vector zero = Vector::Zero(system.size());
  const Vector no_history;
  Vector history;
  u = zero;
  SparseNewton newton(system);
  return newton.solve(assembler, {.z_0 = &zero, .v_0 = &zero, .history = &no_history},
                      {.max_iterations = 200, .line_search = line_search}, u, history);
}

}  // namespace

TEST_CASE("Full Newton cycles for ever on three gaps in a chain, with the exact line search it converges") {
  const System system = build(kCycles);
  Vector u;
  CHECK(solve_on_contacts(system, kCycles, false, u).status == NewtonStatus::too_many_steps);
  CHECK(solve_sparse(system, false, u).status == NewtonStatus::too_many_steps);

  const NewtonResult contacts = solve_on_contacts(system, kCycles, true, u);
  REQUIRE(contacts.status == NewtonStatus::converged);
  CHECK(contacts.iterations <= 8);
  for (int i = 0; i < 3; ++i) CHECK(u[i] == Approx(kRoot[i]).margin(1e-11));

  const NewtonResult sparse = solve_sparse(system, true, u);
  REQUIRE(sparse.status == NewtonStatus::converged);
  CHECK(sparse.iterations <= 8);
  for (int i = 0; i < 3; ++i) CHECK(u[i] == Approx(kRoot[i]).margin(1e-11));
}

TEST_CASE("The exact line search converges on random chains of gaps, from the gap's start") {
  // Convex piecewise-quadratic potential: one root, found in a few iterations. Both solvers agree.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-1.0, 3.0), sign(-1.0, 1.0);
  int full_newton_fails = 0;
  for (int problem = 0; problem < 3000; ++problem) {
    GapChain c;
    for (int i = 0; i < 3; ++i) {
      c.ground.push_back(std::pow(10.0, exponent(random)));
      c.stiffness.push_back(std::pow(10.0, exponent(random)));
      c.half_gap.push_back(0.1 * std::pow(10.0, 0.3 * exponent(random)));
      c.load.push_back(10 * sign(random));
    }
    const System system = build(c);
    Vector u, v;
    const NewtonResult contacts = solve_on_contacts(system, c, true, u);
    const NewtonResult sparse = solve_sparse(system, true, v);
    REQUIRE(contacts.status == NewtonStatus::converged);
    REQUIRE(sparse.status == NewtonStatus::converged);
    REQUIRE(contacts.iterations <= 15);
    REQUIRE((u - v).lpNorm<Eigen::Infinity>() <= 1e-9 * (1.0 + u.lpNorm<Eigen::Infinity>()));
    full_newton_fails += !(solve_on_contacts(system, c, false, v).status == NewtonStatus::converged);
  }
  INFO("full Newton fails on " << full_newton_fails << " of 3000");
  CHECK(full_newton_fails < 3000);
}

TEST_CASE("A damper that jumps in at contact can leave no root, that is said, never accepted") {
  // a u + [u > b] (k (u - b) + d u) = P with a = k = d = b = 1, P = 1.5: R(1-) = -0.5, R(1+) = +0.5.
  struct Jump {
    ScalarResponse operator()(const ScalarInput& in) const {
      if (in.x <= 1.0) return {};
      return {.y = (in.x - 1.0) + in.x, .dy_dx = 2.0};
    }
    std::span<const double> kinks() const { return {&edge, 1}; }
    double edge = 1.0;
  };
  Model m("no root");
  m.add_node("m");
  m.add<Inertia>("J", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Jump>>("jump", {"m"}, Jump{});
  const System system = m.build();
  ContactNewton newton(system, Eigen::MatrixXd::Identity(1, 1), 1.0, 0.0);
  Vector lambda = Vector::Zero(1);
  std::vector<ScalarInput> free(1);
  free[0].x = 1.5;
  const NewtonResult result = newton.solve(free, 1.0, {}, lambda);
  CHECK(result.status != NewtonStatus::converged);
}

TEST_CASE("A force that is not finite ends the iteration") {
  struct Bad {
    ScalarResponse operator()(const ScalarInput& in) const { return {.y = in.x / 0.0, .dy_dx = 1.0}; }
  };
  Model m("bad");
  m.add_node("m");
  m.add<Inertia>("J", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Bad>>("bad", {"m"}, Bad{});
  const System system = m.build();
  ContactNewton newton(system, Eigen::MatrixXd::Identity(1, 1), 1.0, 0.0);
  Vector lambda = Vector::Zero(1);
  std::vector<ScalarInput> free(1);
  free[0].x = 1.5;
  CHECK(newton.solve(free, 1.0, {}, lambda).status == NewtonStatus::not_finite);
}
