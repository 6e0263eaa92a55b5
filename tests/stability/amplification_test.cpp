// The methods on one undamped mode: spectral radius, period and amplitude errors, identities,
// overshoot. Expected: the methods' published formulas, worked out by a separate program.
#include "tests/stability/amplification.hpp"

#include <drev/core/error.hpp>

#include <algorithm>

#include "tests/catch.hpp"

using namespace drev;
using namespace drev::problems;

TEST_CASE("Spectral radius from omega h = 0.1 to 1e4, undamped") {
  const double omega_h[] = {0.1, 1.0, 2.0, kTwoPi, 10.0, 100.0, 1e4};
  struct Row {
    const char* method;
    double radius[7];
  };
  const Row rows[] = {
      {"average_acceleration", {1, 1, 1, 1, 1, 1, 1}},
      {"hht:0.05",
       {.999999439, .9964896684, .9782677516, .9238635631, .9131682874, .9048526986, .9047619138}},
      {"hht:0.1",
       {.9999989934, .9938473293, .9623657046, .8609182035, .8378028340, .8184023292, .8181818403}},
      {"hht:0.3",
       {.9999981747, .9893840771, .9374858849, .7499281592, .6846112833, .5494873492, .5384630677}},
      {"generalized_alpha:0.9",
       {.9999999927, .9999422589, .9994378369, .9920498733, .9837630771, .9284486710, .9014511757}},
      {"generalized_alpha:0.8",
       {.9999999316, .9994746140, .9952858630, .9562792602, .9297917672, .8346376088, .8016748334}},
      {"generalized_alpha:0.5",
       {.9999981604, .9893127860, .9371323065, .7485274904, .6825284215, .5371736239, .5016827188}},
      {"generalized_alpha:0",
       {.9999519177, .9065633333, .7071067812, .3392258126, .2425356250, .0478312817, .0021575274}},
      {"bathe:0.8",
       {.9999999221, .9993130002, .9921480945, .9012545293, .8536293247, .8006816813, .8000000684}},
      {"bathe:0",
       {.9999996327, .9968739365, .9668145623, .6355753142, .4448580600, .0482421052, .0004828427}},
      {"tr_bdf2",
       {.9999996327, .9968739365, .9668145623, .6355753142, .4448580600, .0482421052, .0004828427}},
      {"newmark:0.3025,0.6",
       {.9995013836, .9608457567, .9049886877, .8336450855, .8246211251, .8182485769, .8181818249}}};
  for (const Row& row : rows)
    for (int i = 0; i < 7; ++i) {
      INFO(row.method << " at omega h = " << omega_h[i]);
      // Printed to 10 digits. Near a multiple root rounding is amplified: at 1e4 the roots of
      // generalized-alpha lie 1e-4 of each other.
      CHECK(spectral_radius(amplification(row.method, omega_h[i])) ==
            Approx(row.radius[i]).margin(omega_h[i] > 10.0 ? 1e-7 : 6e-10));
    }
}

TEST_CASE("Period elongation and amplitude decay against the step, undamped") {
  // h/T = 0.01, 0.05, 0.2 (0.1: unit tests of the integration in time).
  const double step[] = {0.01, 0.05, 0.2};
  struct Row {
    const char* method;
    Distortion expected[3];
  };
  const Row rows[] = {
      {"average_acceleration", {{3.2890027e-4, 0}, {.0081712426, 0}, {.12003309, 0}}},
      {"hht:0.05", {{3.7448726e-4, 8.7754917e-6}, {.0092761386, .0010512407}, {.13203353, .038897632}}},
      {"hht:0.1", {{4.1268205e-4, 1.5750272e-5}, {.010202248, .0018811582}, {.14242532, .067541482}}},
      {"hht:0.3", {{4.9153909e-4, 2.8576892e-5}, {.012116663, .0033925098}, {.16487581, .11464751}}},
      {"generalized_alpha:0.8",
       {{3.4716936e-4, 1.0680822e-6}, {.0086232825, 1.3092358e-4}, {.12635094, .0064447382}}},
      {"generalized_alpha:0.9",
       {{3.3299977e-4, 1.1353428e-7}, {.0082728786, 1.3959993e-5}, {.12149476, 7.1945419e-4}}},
      {"bathe:0.8", {{9.5061452e-5, 1.2154084e-6}, {.0023708848, 1.5038013e-4}, {.036628071, .0082529092}}},
      {"bathe:0", {{1.5962523e-4, 5.731928e-6}, {.0039751997, 7.0745397e-4}, {.060210578, .037285748}}},
      {"generalized_alpha:0",  // Houbolt's
       {{.0017962666, 7.6825833e-4}, {.03908441, .07044498}, {.34366753, .65399678}}}};
  for (const Row& row : rows)
    for (int i = 0; i < 3; ++i) {
      INFO(row.method << " at h/T = " << step[i]);
      const Distortion d = distortion(row.method, step[i]);
      CHECK(d.elongation == Approx(row.expected[i].elongation).epsilon(2e-7));
      CHECK(d.decay == Approx(row.expected[i].decay).epsilon(2e-7).margin(2e-12));
    }
}

TEST_CASE("Period elongation of Newmark with gamma = 1/2 is (beta - 1/12)/2 of (omega h)^2") {
  for (const double beta : {0.0, 1.0 / 12.0, 1.0 / 6.0, 0.25, 0.3}) {
    const double omega_h = 0.02;
    const Distortion d = distortion("newmark:" + to_text(beta) + ",0.5", omega_h / kTwoPi);
    INFO("beta = " << beta);
    CHECK(d.elongation / (omega_h * omega_h) == Approx(0.5 * (beta - 1.0 / 12.0)).margin(3e-5));
    CHECK(std::abs(d.decay) < 1e-12);
  }
}

TEST_CASE("generalized-alpha with rho_inf = 1/2 is HHT with alpha = 1/3") {
  for (const double omega_h : {0.1, 2.0, 30.0}) {
    const System system = unit_frequency(0.05);
    const auto a = run_steps(system, "generalized_alpha:0.5", omega_h, 1.0, 0.3, 50);
    const auto b = run_steps(system, "hht:" + to_text(1.0 / 3.0), omega_h, 1.0, 0.3, 50);
    for (std::size_t i = 0; i < a.size(); ++i) CHECK((a[i] - b[i]).norm() < 1e-12);
  }
}

TEST_CASE("generalized-alpha with rho_inf = 0 has Houbolt's characteristic polynomial") {
  // (2 + O^2) r^3 - 5 r^2 + 4 r - 1, O = omega h. Houbolt 1950, doi:10.2514/8.1722.
  for (const double omega_h : {0.3, 2.0, 10.0}) {
    const Eigen::MatrixXd a = amplification("generalized_alpha:0", omega_h);
    REQUIRE(a.rows() == 3);
    const double c = 2.0 + omega_h * omega_h, trace = a.trace();
    CHECK(trace == Approx(5.0 / c).epsilon(1e-9));
    CHECK(0.5 * (trace * trace - (a * a).trace()) == Approx(4.0 / c).epsilon(1e-9));
    CHECK(a.determinant() == Approx(1.0 / c).epsilon(1e-9));
  }
}

TEST_CASE("Overshoot in 20 steps of ten periods each") {
  // Largest |z| and |v|/omega from z = 1, v = 0 at h = 10 T. Dissipative methods with a velocity of
  // their own overshoot in it, the more so the larger the step: 15.7 fold with rho_inf = 0.
  struct Row {
    const char* method;
    double z, v;
  };
  for (const Row& row : {Row{"average_acceleration", .99798, .95593},
                         {"hht:0.05", .90769, .78602},
                         {"hht:0.3", .68917, 3.67114},
                         {"generalized_alpha:0.8", .94209, 1.47153},
                         {"generalized_alpha:0", .50051, 15.73182},
                         {"bathe:0.8", .77253, .37393},
                         {"bathe:0", .01123, .07585}}) {
    const double omega_h = 10.0 * kTwoPi;
    const auto states = run_steps(unit_frequency(0.0), row.method, omega_h, 1.0, 0.0, 20);
    double z = 0.0, v = 0.0;
    for (std::size_t i = 1; i < states.size(); ++i) {
      z = std::max(z, std::abs(states[i][0]));
      v = std::max(v, std::abs(states[i][1]));
    }
    INFO(row.method);
    CHECK(z == Approx(row.z).margin(6e-6));
    CHECK(v == Approx(row.v).margin(6e-6));
  }
}
