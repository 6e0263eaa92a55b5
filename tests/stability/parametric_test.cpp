// Parametric instability of gear meshes at constant speed: Floquet multipliers of one mesh period, measured
// from unit starts, against closed-form boundaries.
//
// The stiffness jumps half way between two steps, where average acceleration keeps its second order.
#include <drev/core/units.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/dense/eigenvalues.hpp"
#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

/// Rectangular, mean 1, k_double/k_single = 1.5.
MeshStiffness meissner(double contact_ratio) {
  const double single = 1.0 / (1.0 + 0.5 * (contact_ratio - 1.0));
  return MeshStiffness::step(single, 1.5 * single, contact_ratio);
}

/// (z, v) after one mesh period of `steps` steps from unit (z, v): the monodromy matrix.
Eigen::MatrixXd monodromy(const System& system, double period, int steps,
                          const StepScheme& scheme = average_acceleration(), double unit = 1.0) {
  const int n = system.size();
  Eigen::MatrixXd m(2 * n, 2 * n);
  for (int i = 0; i < 2 * n; ++i) {
    State s = State::initial(system);
    (i < n ? s.z[i] : s.v[i - n]) = unit;
    simulate(system, {.scheme = scheme, .step = period / steps, .t_end = period, .energy_tolerance = 1e9}, s);
    m.col(i) << s.z / unit, s.v / unit;
  }
  return m;
}

/// Natural frequency 1, mesh frequency w, damping ratio zeta.
Eigen::MatrixXd pair_monodromy(const MeshStiffness& stiffness, double zeta, double w, int steps = 2000) {
  const System system =
      DrivenGear{.speed = w, .stiffness = stiffness, .damping = 2.0 * zeta, .mesh_phase = 0.5 / steps}
          .build();
  return monodromy(system, kTwoPi / w, steps);
}

/// w in [stable, unstable] at which grows(w) changes, to 1e-8.
template <class Grows>
double boundary(double stable, double unstable, const Grows& grows) {
  REQUIRE(!grows(stable));
  REQUIRE(grows(unstable));
  while (std::abs(unstable - stable) > 1e-8) {
    const double w = 0.5 * (stable + unstable);
    (grows(w) ? unstable : stable) = w;
  }
  return 0.5 * (stable + unstable);
}

/// Both ends of the tongue about `inside`, searched for no further than `reach`.
template <class Grows>
std::pair<double, double> tongue(double inside, double reach, const Grows& grows) {
  return {boundary(inside - reach, inside, grows), boundary(inside + reach, inside, grows)};
}

}  // namespace

TEST_CASE("Mesh with stepped stiffness: tongues of Meissner's equation, undamped") {
  // tr/2 = cos A cos B - (w_1/w_2 + w_2/w_1) sin A sin B/2, A = w_1 c T, B = w_2 (1 - c) T: +-1 at the ends.
  struct Row {
    double contact_ratio;
    std::pair<double, double> ends[4];
  };
  for (const Row& row : {Row{1.5,
                             {{.49272887047159, .50221968865884},
                              {.65092998193358, .67625359419108},
                              {.98495402442808, 1.004924993616},
                              {1.8710541957855, 2.1252722147406}}},
                         {1.2,
                          {{.49651980426142, .49964521833292},
                           {.65260565058787, .67548213246174},
                           {.96557334695877, 1.0294464645841},
                           {1.9131540069082, 2.0865112760176}}}}) {
    const auto grows = [&](double w) {
      return std::abs(pair_monodromy(meissner(row.contact_ratio), 0.0, w).trace()) > 2.0;
    };
    for (const auto& [low, high] : row.ends) {
      const auto [from, to] = tongue(0.5 * (low + high), high - low, grows);
      INFO("contact ratio " << row.contact_ratio << ": " << from << ", " << to);
      // Average acceleration shifts frequencies by w^2 h^2/12: 4e-6 of the lowest tongue's at 2000 steps.
      CHECK(from == Approx(low).epsilon(1e-5));
      CHECK(to == Approx(high).epsilon(1e-5));
    }
  }
}

TEST_CASE("Mesh with stepped stiffness: damping narrows the primary tongue and closes the others") {
  struct Row {
    double contact_ratio, zeta, low, high;
  };
  for (const Row& row : {Row{1.5, .02, 1.8770879929279, 2.1184359568012},
                         {1.5, .05, 1.9169701715509, 2.0743382093342},
                         {1.6, .03, 1.8995014585153895, 2.096347210241158},
                         {1.25, .05, 1.9766774169767, 2.0170863612213}}) {
    const auto grows = [&](double w) {
      return spectral_radius(pair_monodromy(meissner(row.contact_ratio), row.zeta, w)) > 1.0;
    };
    const auto [from, to] = tongue(0.5 * (row.low + row.high), 0.2, grows);
    CHECK(from == Approx(row.low).epsilon(1e-5));
    CHECK(to == Approx(row.high).epsilon(1e-5));
    // Elsewhere in [0.45, 2.6] nothing grows.
    for (double w = 0.45; w < 2.6; w += 0.0137)
      if (w < row.low - 1e-3 || w > row.high + 1e-3) {
        INFO("contact ratio " << row.contact_ratio << ", zeta " << row.zeta << ", w = " << w);
        CHECK(!grows(w));
      }
  }
  for (const double contact_ratio : {1.2, 1.8})
    for (double w = 0.45; w < 2.6; w += 0.0137) {
      INFO("contact ratio " << contact_ratio << ", w = " << w);
      CHECK(spectral_radius(pair_monodromy(meissner(contact_ratio), 0.05, w, 1000)) < 1.0);
    }
}

TEST_CASE("Mesh with stepped stiffness: multipliers at w = 2 and the damping that closes the tongue") {
  const Eigen::MatrixXd m = pair_monodromy(meissner(1.5), 0.0, 2.0);
  CHECK(spectral_radius(m) == Approx(1.22089514416751).epsilon(1e-5));
  CHECK(m.trace() == Approx(-1.22089514416751 - .81907115838508).epsilon(1e-6));
  CHECK(m.determinant() == Approx(1.0).epsilon(1e-5));
  for (const auto& [contact_ratio, critical] : {std::pair{1.5, .063664415}, {1.2, .043415271}}) {
    const auto largest = [&](double zeta) {
      double most = 0.0;
      for (double w = 1.97; w < 2.03; w += 0.005)
        most = std::max(most, spectral_radius(pair_monodromy(meissner(contact_ratio), zeta, w, 1000)));
      return most;
    };
    INFO("contact ratio " << contact_ratio);
    CHECK(largest(critical - 2e-4) > 1.0);
    CHECK(largest(critical + 2e-4) < 1.0);
  }
}

TEST_CASE("Mesh with one harmonic: tongues of Mathieu's equation") {
  // x'' + (1 + 0.2 cos w t) x = 0.
  const MeshStiffness k = MeshStiffness::fourier(1.0, {{1.0, 0.2, 0.0}});
  const auto grows = [&](double w) { return std::abs(pair_monodromy(k, 0.0, w).trace()) > 2.0; };
  const auto primary = tongue(2.0, 0.3, grows), secondary = tongue(0.997, 0.03, grows);
  CHECK(primary.first == Approx(1.89884811049666).epsilon(1e-5));
  CHECK(primary.second == Approx(2.09868756052657).epsilon(1e-5));
  CHECK(secondary.first == Approx(.991670416202937).epsilon(1e-5));
  CHECK(secondary.second == Approx(1.00165863195675).epsilon(1e-5));
}

TEST_CASE("Two meshes in a train: their phase decides which tongues are there") {
  // Three inertias 1, two meshes 1 +- 0.2 square, free-free: natural frequencies 1 and sqrt 3. Tongues at
  // twice each and at their sum; in phase the sum's vanishes, in opposite phase the others do.
  const auto train = [](double phase, double w, int steps) {
    Model m("train");
    for (const char* node : {"a", "b", "c"}) {
      m.add_node(node);
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0});
    }
    const auto mesh = [&](double offset) {
      return GearMesh::Params{.base_radius_1 = 1.0,
                              .base_radius_2 = 1.0,
                              .teeth_1 = 1,
                              .teeth_2 = 1,
                              .stiffness = MeshStiffness::step(0.8, 1.2, 1.5),
                              .mesh_phase = offset + 0.5 / steps};
    };
    // a and c turn the same way.
    m.add<GearMesh>("mesh_1", {"a", "b"}, mesh(0.0));
    m.add<GearMesh>("mesh_2", {"c", "b"}, mesh(phase));
    m.set_reference("a", constant_speed(w));
    // The stiffness follows the actual angles: small deviations, so that the phase is that of the speed.
    return spectral_radius(monodromy(m.build(), kTwoPi / w, steps, average_acceleration(), 1e-7));
  };
  const double primary_1 = 2.0, sum = 1.0 + std::sqrt(3.0), primary_2 = 2.0 * std::sqrt(3.0);
  struct Row {
    double phase, rho_1, rho_sum, rho_2;
  };
  for (const Row& row : {Row{0.0, 1.220895144168, 1.0, 1.220895144168},
                         {0.25, 1.147511924566, 1.148037450106, 1.151815042000},
                         {0.5, 1.0, 1.211872168294, 1.0}}) {
    INFO("phase " << row.phase);
    // The rigid motion's multiplier 1 is double: rounding splits it by sqrt(1e-9) where nothing else grows.
    CHECK(train(row.phase, primary_1, 2000) == Approx(row.rho_1).margin(2e-4));
    CHECK(train(row.phase, sum, 2000) == Approx(row.rho_sum).margin(2e-4));
    CHECK(train(row.phase, primary_2, 2000) == Approx(row.rho_2).margin(2e-4));
  }
  struct Tongue {
    double phase, low, high;
  };
  for (const Tongue& t : {Tongue{0.0, 1.8710542, 2.1252722},
                          {0.0, 3.2407609, 3.6810795},
                          {0.25, 1.9046721, 2.0777408},
                          {0.25, 2.6054680, 2.8426236},
                          {0.25, 3.3163169, 3.6243829},
                          {0.5, 2.5625900, 2.8969245}}) {
    const double inside = 2e-3 * t.low;
    INFO("phase " << t.phase << ", tongue from " << t.low << " to " << t.high);
    CHECK(train(t.phase, t.low - inside, 2000) < 1.001);
    CHECK(train(t.phase, t.low + inside, 2000) > 1.005);
    CHECK(train(t.phase, t.high - inside, 2000) > 1.005);
    CHECK(train(t.phase, t.high + inside, 2000) < 1.001);
  }
}
