/// Sturm counts against the closed form of the uniform chain.
#include "solvers/linear/sturm_count.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Uniform chain of n inertias J = 1, springs k = 1: lambda_j = 4 sin^2(j pi / 2n) free, j =
/// 0..n-1; 4 sin^2((2j - 1) pi / (4n + 2)) with one end held by another spring, j = 1..n.
struct Chain {
  SparseMatrix pattern;
  Vector stiffness, mass;

  Chain(int n, bool held) : pattern(n, n) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, (i > 0 || held ? 1.0 : 0.0) + (i + 1 < n ? 1.0 : 0.0));
      if (i + 1 < n) entries.emplace_back(i, i + 1, -1.0), entries.emplace_back(i + 1, i, -1.0);
    }
    pattern.setFromTriplets(entries.begin(), entries.end());
    stiffness = Eigen::Map<Vector>(pattern.valuePtr(), pattern.nonZeros());
    mass.setZero(pattern.nonZeros());
    for (int j = 0; j < n; ++j)
      for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s)
        if (pattern.innerIndexPtr()[s] == j) mass[s] = 1.0;
  }
};

}  // namespace

TEST_CASE("Sturm count of uniform chains, free and held", "[InertiaCounter]") {
  for (const int n : {10, 50, 2000})
    for (const bool held : {false, true}) {
      const Chain chain(n, held);
      InertiaCounter counter(chain.pattern, chain.stiffness, chain.mass);
      const auto lambda = [&](int j) {  // j from 0
        const double sine = std::sin(held ? (2 * j + 1) * kPi / (4 * n + 2) : j * kPi / (2 * n));
        return 4.0 * sine * sine;
      };
      CHECK(counter.count_below(-1.0).below == 0);
      CHECK(counter.count_below(4.1).below == n);
      int trusted = 0;
      for (int j = 0; j < 9; ++j) {
        // two places between lambda_j and lambda_j+1: one of them may meet a tiny pivot
        for (const double fraction : {0.5, 0.382}) {
          const SturmCount count = counter.count_below(lambda(j) + fraction * (lambda(j + 1) - lambda(j)));
          if (count.trusted) {
            ++trusted;
            CHECK(count.below == j + 1);
          }
        }
      }
      CHECK(trusted >= 12);
    }
}

TEST_CASE("A zero pivot is not trusted", "[InertiaCounter]") {
  // K - s M = [0 -1; -1 0] at s = 1: eigenvalues -1 and 1, but no LDL' without pivoting
  const Chain chain(2, false);
  InertiaCounter counter(chain.pattern, chain.stiffness, chain.mass);
  CHECK_FALSE(counter.count_below(1.0).trusted);
  CHECK_FALSE(counter.count_below(1.0 + 1e-9).trusted);
  const SturmCount next = counter.count_below(1.01);
  CHECK(next.trusted);
  CHECK(next.below == 1);
  CHECK_THROWS_AS(counter.count_below(NAN), SolverError);
}
