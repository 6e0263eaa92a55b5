// Modes of random models of shafts and gears, with branches, several parts and wide spreads of inertia and
// stiffness, against eigenvalues of the same model by Jacobi's method in 113 bits. How many rigid modes there
// are is known from how each model was made.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/stability/random_model.hpp"

using namespace drev;

namespace {

__extension__ using Wide = __float128;

Wide root(Wide x) {
  if (!(x > 0)) return 0;
  Wide y = static_cast<Wide>(std::sqrt(static_cast<long double>(x)));
  for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
  return y;
}
Wide size_of(Wide x) { return x < 0 ? -x : x; }

using WideMatrix = std::vector<std::vector<Wide>>;

/// Eigenvalues, ascending, by cyclic Jacobi rotations.
std::vector<double> eigenvalues(WideMatrix a) {
  const std::size_t n = a.size();
  for (int sweep = 0; sweep < 60; ++sweep) {
    bool rotated = false;
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        const Wide limit = static_cast<Wide>(1e-31L) * root(size_of(a[p][p] * a[q][q]));
        if (!(size_of(a[p][q]) > limit)) continue;
        rotated = true;
        const Wide theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const Wide t = (theta < 0 ? -1 : 1) / (size_of(theta) + root(theta * theta + 1));
        const Wide c = 1 / root(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < n; ++k) {
          const Wide x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const Wide x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
      }
    if (!rotated) break;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(static_cast<double>(a[i][i]));
  std::sort(values.begin(), values.end());
  return values;
}

struct Case {
  System system;
  int rigid = 0;                // contacts open
  std::vector<double> elastic;  // Hz, ascending, contacts open
};

/// Parts of shafts and gears without backlash, each a tree with now and then a second shaft beside the first;
/// held or free; each hangs on the one before it by a mesh with backlash, which carries nothing while open.
Case random_case(Random& random, double inertia_decades, double stiffness_decades, int most) {
  const auto spread = [&](double decades) { return random.decade(-0.5 * decades, 0.5 * decades); };
  const auto name = [](const char* prefix, std::size_t i) { return prefix + std::to_string(i); };
  struct Spring {
    std::size_t i, j;
    double b_i, b_j, k;
  };
  std::vector<double> inertia;
  std::vector<Spring> springs;
  Model model("random");
  int rigid = 0;
  const auto shaft = [&](std::size_t i, std::size_t j) {
    const double k = 1e4 * spread(stiffness_decades);
    model.add<ShaftSpring>(name("s", springs.size()), {name("n", i), name("n", j)}, {.stiffness = k});
    springs.push_back({i, j, 1.0, -1.0, k});
  };
  for (int parts = 1 + random.below(3), part = 0; part < parts; ++part) {
    const std::size_t first = inertia.size(), nodes = 1 + static_cast<std::size_t>(random.below(most));
    for (std::size_t i = first; i < first + nodes; ++i) {
      inertia.push_back(0.1 * spread(inertia_decades));
      model.add_node(name("n", i));
      model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertia.back()});
      if (i == first) continue;
      // Most often a chain, else a branch anywhere.
      const std::size_t to =
          random.below(3) > 0 ? i - 1
                              : first + static_cast<std::size_t>(random.below(static_cast<int>(i - first)));
      if (random.below(5) == 0) {
        const double r_1 = random(0.02, 0.2), r_2 = random(0.02, 0.2);
        const double k = 1e6 * spread(stiffness_decades);
        model.add<GearMesh>(name("g", springs.size()), {name("n", to), name("n", i)},
                            {.base_radius_1 = r_1, .base_radius_2 = r_2, .stiffness = k});
        springs.push_back({to, i, r_1, r_2, k});
      } else {
        shaft(to, i);
        if (random.below(8) == 0) shaft(to, i);
      }
    }
    if (random.below(2) == 0) {
      const double k = 1e4 * spread(stiffness_decades);
      model.add<GroundSpring>(name("s", springs.size()), {name("n", first)}, {.stiffness = k});
      springs.push_back({first, first, 1.0, 0.0, k});
    } else {
      ++rigid;
    }
    if (part > 0)
      model.add<GearMesh>(
          name("m", first), {name("n", first - 1), name("n", first)},
          {.base_radius_1 = 0.1, .base_radius_2 = 0.05, .stiffness = 1e8, .normal_backlash = 1e-4});
  }
  WideMatrix a(inertia.size(), std::vector<Wide>(inertia.size(), 0));
  for (const Spring& s : springs) {
    const Wide k = s.k, b_i = s.b_i, b_j = s.b_j;
    a[s.i][s.i] += k * b_i * b_i;
    if (s.i == s.j) continue;
    a[s.j][s.j] += k * b_j * b_j;
    a[s.i][s.j] += k * b_i * b_j;
    a[s.j][s.i] += k * b_i * b_j;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a.size(); ++j) a[i][j] /= root(static_cast<Wide>(inertia[i]) * inertia[j]);
  Case made{.system = model.build(), .rigid = rigid, .elastic = {}};
  const std::vector<double> lambda = eigenvalues(a);
  for (std::size_t i = static_cast<std::size_t>(rigid); i < lambda.size(); ++i)
    made.elastic.push_back(to_hz(std::sqrt(lambda[i])));
  return made;
}

/// Solves for some of the modes and compares each with the reference. False: refused, for its spread.
bool compare(const Case& made, const ModesOptions& options) {
  ModeSet modes;
  try {
    modes = solve_modes(made.system, options);
  } catch (const SolverError& error) {
    const std::string what = error.what();
    if (what.find("spread too widely") == std::string::npos &&
        what.find("too small beside the others") == std::string::npos)
      throw;
    return false;
  }
  REQUIRE(modes.rigid_modes == made.rigid);
  for (std::size_t j = 0; j < modes.frequency_Hz.size(); ++j) {
    const double off = std::abs(modes.frequency_Hz[j] - made.elastic[j]);
    INFO("mode " << j << ": " << modes.frequency_Hz[j] << " +- " << modes.error_Hz[j] << ", off by " << off);
    CHECK(off <= modes.error_Hz[j] + 1e-14 * made.elastic[j]);
    CHECK(modes.error_Hz[j] <= 0.12 * made.elastic[j]);
  }
  return true;
}

}  // namespace

TEST_CASE("Random models with parts, branches and open contacts: all modes, each within its error",
          "[modes]") {
  Random random(1);
  int refused_in_nine = 0, refused = 0;  // where rounding leaves nothing
  for (int i = 0; i < 400; ++i) {
    const double decades = 3.0 * (i % 5);
    const Case made = random_case(random, decades, decades, i % 5 == 0 ? 24 : 8);
    INFO("model " << i << ", " << made.system.size() << " unknowns, spread over " << decades << " decades");
    const auto elastic = static_cast<int>(made.elastic.size());
    bool found = compare(made, {.contact = Contact::open});
    for (const int limit : {0, 1000})
      if (elastic > 0)
        for (const int count : {elastic, 1 + random.below(elastic)})
          found &= compare(made, {.count = count, .contact = Contact::open, .dense_limit = limit});
    if (decades < 9.0) CHECK(found);
    refused_in_nine += decades == 9.0 && !found;
    refused += !found;
  }
  CHECK(refused_in_nine <= 2);
  CHECK(refused <= 20);
}
