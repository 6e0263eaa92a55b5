// Newton on dead zones from any start. The potential is convex and piecewise quadratic: one root.
// Plain Newton may still cycle for ever, from three gaps in a chain or four in a loop on; with one or
// two gaps and on a star of gaps about a hub it cannot. With the exact line search it never does.
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <random>

#include "solvers/contact/contact_newton.hpp"
#include "solvers/contact/sparse_newton.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Discs on ground springs; gap j acts between two discs, or one and ground (first < 0).
struct Gaps {
  std::vector<double> ground, load;  // per disc
  struct Contact {
    int first, second;
    double stiffness, half_gap;
  };
  std::vector<Contact> contacts;

  System build() const {
    Model m("gaps");
    const auto node = [](int i) { return "m" + std::to_string(i); };
    for (std::size_t i = 0; i < ground.size(); ++i) {
      const std::string n = node(static_cast<int>(i));
      m.add_node(n);
      m.add<Inertia>("J" + n, {n}, {.inertia = 1.0});
      m.add<GroundSpring>("ground" + n, {n}, {.stiffness = ground[i]});
      const double p = load[i];
      m.add<AppliedTorque>("load" + n, {n}, {.torque = [p](double) { return p; }});
    }
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const Contact& c = contacts[j];
      const std::vector<NodeRef> ends = c.first < 0 ? std::vector<NodeRef>{node(c.second)}
                                                    : std::vector<NodeRef>{node(c.first), node(c.second)};
      m.add("gap" + std::to_string(j), ends,
            std::make_shared<PolylineSpring>(PolylineSpring::dead_band(c.stiffness, c.half_gap)));
    }
    return m.build();
  }
  Eigen::MatrixXd rows() const {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(size(), static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      b(contacts[j].second, k) = 1.0;
      if (contacts[j].first >= 0) b(contacts[j].first, k) = -1.0;
    }
    return b;
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(ground.size()); }
};

/// Static equilibrium of one problem from many starts, by both of the engine's Newtons.
class Problem {
 public:
  explicit Problem(const Gaps& gaps)
      : gaps_(gaps), system_(gaps.build()), assembler_(system_), newton_(system_), b_(gaps.rows()) {
    const Vector a = Eigen::Map<const Vector>(gaps.ground.data(), gaps.size());
    const Vector p = Eigen::Map<const Vector>(gaps.load.data(), gaps.size());
    u_free_ = p.cwiseQuotient(a);
    w_ = a.cwiseInverse().asDiagonal() * b_;
    contacts_ = ContactNewton(system_, b_.transpose() * w_, 1.0, 0.0);
  }
  /// From displacements u of the masses; the solution comes back in u.
  NewtonResult sparse(bool line_search, Vector& u) {
    const Vector zero = Vector::Zero(system_.size());
    Vector history, z(u.size());
    const auto unknown = [this](Eigen::Index mass) {
      return system_.node_map(static_cast<int>(mass)).unknown;
    };
    for (Eigen::Index i = 0; i < u.size(); ++i) z[unknown(i)] = u[i];
    const NewtonResult result =
        newton_.solve(assembler_, {.z_0 = &zero, .v_0 = &zero, .history = &history},
                      {.max_iterations = 100, .line_search = line_search}, z, history);
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = z[unknown(i)];
    return result;
  }
  /// From the contact forces lambda; the displacements come back in u.
  NewtonResult on_contacts(bool line_search, Vector lambda, Vector& u) {
    std::vector<ScalarInput> free(gaps_.contacts.size());
    const Vector x = b_.transpose() * u_free_;
    for (std::size_t j = 0; j < free.size(); ++j) free[j].x = x[static_cast<Eigen::Index>(j)];
    const NewtonResult result = contacts_.solve(
        free, 10.0, {.max_iterations = 100, .line_search = line_search, .expects = false}, lambda);
    u = u_free_ - w_ * lambda;
    return result;
  }
  Vector zero_forces() const { return Vector::Zero(b_.cols()); }

 private:
  const Gaps& gaps_;
  System system_;
  Assembler assembler_;
  SparseNewton newton_;
  Eigen::MatrixXd b_, w_;
  Vector u_free_;
  ContactNewton contacts_;
};

bool converged(const NewtonResult& r) { return r.status == NewtonStatus::converged; }

/// Ground - m1 - m2 - m3 with k = (500, 200, 50): plain Newton from the gap cycles for ever.
const Gaps kCycles{{5, 1, 200}, {8, -2, -5}, {{-1, 0, 500, .1}, {0, 1, 200, .1}, {1, 2, 50, .5}}};
const double kRoot[3] = {0.11088933680743326, 0.0008849122462022629, -0.025};

enum class Layout { pair, chain, loop, star };

/// Stiffnesses over four decades, gaps over one and a bit.
Gaps random_gaps(Layout layout, std::mt19937& random) {
  const auto decade = [&](double low, double high) {
    return std::pow(10.0, std::uniform_real_distribution<double>(low, high)(random));
  };
  const int discs = layout == Layout::pair ? 2 : layout == Layout::chain ? 3 : 4;
  Gaps g;
  for (int i = 0; i < discs; ++i) {
    g.ground.push_back(decade(-1.0, 3.0));
    g.load.push_back(std::uniform_real_distribution<double>(-10.0, 10.0)(random));
  }
  const auto add = [&](int first, int second) {
    g.contacts.push_back({first, second, decade(-1.0, 3.0), 0.1 * decade(-0.3, 0.9)});
  };
  if (layout == Layout::pair || layout == Layout::chain)
    for (int i = 0; i < discs; ++i) add(i - 1, i);
  if (layout == Layout::loop)
    for (int i = 0; i < 4; ++i) add(i, (i + 1) % 4);
  if (layout == Layout::star)
    for (int i = 1; i < 4; ++i) add(0, i);
  return g;
}

}  // namespace

TEST_CASE(
    "The smallest known cycle: from the gap plain Newton never ends, from all 27 patterns ours "
    "does") {
  Problem problem(kCycles);
  Vector u = Vector::Zero(3);
  CHECK(problem.sparse(false, u).status == NewtonStatus::too_many_steps);
  CHECK(problem.on_contacts(false, problem.zero_forces(), u).status == NewtonStatus::too_many_steps);
  int most = 0;
  for (int pattern = 0; pattern < 27; ++pattern) {
    // Deflections of twice the half gap forward, backward, or none.
    const int s[3] = {pattern % 3 - 1, pattern / 3 % 3 - 1, pattern / 9 - 1};
    Vector start(3), lambda(3), v;
    double position = 0.0;
    for (int j = 0; j < 3; ++j) {
      const Gaps::Contact& c = kCycles.contacts[static_cast<std::size_t>(j)];
      start[j] = position += 2.0 * s[j] * c.half_gap;
      lambda[j] = s[j] * c.stiffness * c.half_gap;
    }
    INFO("pattern " << s[0] << " " << s[1] << " " << s[2]);
    const NewtonResult by_sparse = problem.sparse(true, start);
    const NewtonResult by_contacts = problem.on_contacts(true, lambda, v);
    REQUIRE(converged(by_sparse));
    REQUIRE(converged(by_contacts));
    for (int i = 0; i < 3; ++i) {
      CHECK(start[i] == Approx(kRoot[i]).margin(1e-11));
      CHECK(v[i] == Approx(kRoot[i]).margin(1e-11));
    }
    most = std::max({most, by_sparse.iterations, by_contacts.iterations});
  }
  CHECK(most <= 9);
}

TEST_CASE("Random gaps in a pair, chain, loop and star: ours converges from any start") {
  struct Row {
    Layout layout;
    const char* name;
    int problems;
    bool plain_can_cycle;  // Ben Gharbia, Gilbert, INRIA RR-7160, and by trial
  };
  for (const Row& row : {Row{Layout::pair, "pair", 1000, false}, Row{Layout::chain, "chain", 6000, true},
                         Row{Layout::loop, "loop", 3000, true}, Row{Layout::star, "star", 2000, false}}) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> sign(-1.0, 1.0);
    int plain_fails = 0, most = 0;
    for (int i = 0; i < row.problems; ++i) {
      const Gaps gaps = random_gaps(row.layout, random);
      Problem problem(gaps);
      Vector reference, u = Vector::Zero(gaps.size());
      const NewtonResult first = problem.on_contacts(true, problem.zero_forces(), reference);
      REQUIRE(converged(first));
      const double scale = 1.0 + reference.lpNorm<Eigen::Infinity>();
      most = std::max(most, first.iterations);
      plain_fails += !converged(problem.sparse(false, u));
      for (int start = 0; start < 3; ++start) {
        Vector lambda = problem.zero_forces(), v;
        for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = sign(random);
        for (Eigen::Index k = 0; k < lambda.size(); ++k) lambda[k] = 100.0 * sign(random);
        const NewtonResult by_sparse = problem.sparse(true, u);
        const NewtonResult by_contacts = problem.on_contacts(true, lambda, v);
        REQUIRE(converged(by_sparse));
        REQUIRE(converged(by_contacts));
        REQUIRE((u - reference).lpNorm<Eigen::Infinity>() < 1e-9 * scale);
        REQUIRE((v - reference).lpNorm<Eigen::Infinity>() < 1e-9 * scale);
        most = std::max({most, by_sparse.iterations, by_contacts.iterations});
      }
    }
    INFO(row.name << ": plain Newton fails on " << plain_fails << " of " << row.problems
                  << ", most iterations " << most);
    CHECK((plain_fails > 0) == row.plain_can_cycle);
    CHECK(most <= 15);
  }
}

TEST_CASE("A spring that softens: plain Newton cycles beyond the closed-form threshold, ours never") {
  // Slope a + 10 within +-1, a + 1 beyond: from x = 3 the iterates run 3, -9/(a + 1), 9/(a + 1), ...
  // for ever if they stay outside, that is if a + 10 > 2 (a + 1): a < 8.
  for (const double a : {1.0, 7.99, 8.01, 20.0}) {
    Model m("softening");
    m.add_node("m");
    m.add<Inertia>("J", {"m"}, {.inertia = 1.0});
    m.add<GroundSpring>("ground", {"m"}, {.stiffness = a});
    m.add<PolylineSpring>("spring", {"m"}, PolylineSpring::with_stops(10.0, 1.0, 1.0));
    const System system = m.build();
    const Assembler assembler(system);
    const Vector zero = Vector::Zero(1);
    Vector history;
    SparseNewton newton(system);
    const auto solve = [&](bool line_search, Vector& u) {
      u = Vector::Constant(1, 3.0);
      return newton.solve(assembler, {.z_0 = &zero, .v_0 = &zero, .history = &history},
                          {.max_iterations = 100, .line_search = line_search}, u, history);
    };
    Vector u;
    INFO("a = " << a);
    CHECK(converged(solve(false, u)) == (a > 8.0));
    REQUIRE(converged(solve(true, u)));
    CHECK(std::abs(u[0]) < 1e-12);
  }
}
