// Complex elimination, one frequency or eight at once, against dense solutions of the same matrices.
#include "solvers/linear/complex_elimination.hpp"

#include <complex>
#include <random>

#include "core/dense/factorization.hpp"
#include "solvers/linear/lane_elimination.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

using Complex = std::complex<double>;

struct Matrices {
  SparseMatrix pattern;
  Vector m, c, k;

  /// Inertias of 1 at all nodes, springs k and dampers c between those named.
  Matrices(int n, const std::vector<std::pair<int, int>>& shafts, double damping) : pattern(n, n) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 0.0);
    for (const auto& [a, b] : shafts) entries.emplace_back(a, b, 0.0), entries.emplace_back(b, a, 0.0);
    pattern.setFromTriplets(entries.begin(), entries.end());
    m.setZero(pattern.nonZeros());
    c = k = m;
    std::mt19937 draw(7);
    std::uniform_real_distribution<double> number(0.5, 2.0);
    for (int i = 0; i < n; ++i) m[place(i, i)] = number(draw);
    for (const auto& [a, b] : shafts) {
      const double stiffness = 100.0 * number(draw);
      for (const auto& [row, column] : {std::pair{a, a}, std::pair{b, b}, std::pair{a, b}, std::pair{b, a}}) {
        k[place(row, column)] += row == column ? stiffness : -stiffness;
        c[place(row, column)] += damping * (row == column ? stiffness : -stiffness);
      }
    }
  }
  Eigen::Index place(int row, int column) const {
    for (int s = pattern.outerIndexPtr()[column]; s < pattern.outerIndexPtr()[column + 1]; ++s)
      if (pattern.innerIndexPtr()[s] == row) return s;
    return -1;
  }
  Eigen::MatrixXcd at(Complex s) const {
    Eigen::MatrixXcd a = Eigen::MatrixXcd::Zero(pattern.rows(), pattern.cols());
    for (int j = 0; j < pattern.cols(); ++j)
      for (int e = pattern.outerIndexPtr()[j]; e < pattern.outerIndexPtr()[j + 1]; ++e)
        a(pattern.innerIndexPtr()[e], j) = k[e] + s * c[e] + s * s * m[e];
    return a;
  }
};

void check_against_dense(const Matrices& a, Complex s, double tolerance) {
  ComplexElimination elimination(a.pattern);
  REQUIRE(elimination.factorize(a.m, a.c, a.k, s));
  const Eigen::Index n = a.pattern.rows();
  Eigen::VectorXcd b(n);
  for (Eigen::Index i = 0; i < n; ++i)
    b[i] = Complex(1.0 + static_cast<double>(i), -0.3 * static_cast<double>(i));
  Eigen::VectorXcd x = b;
  elimination.solve(x.data());
  const Eigen::VectorXcd expected = lu_solve(a.at(s), b);
  CHECK((x - expected).norm() < tolerance * expected.norm());
}

}  // namespace

TEST_CASE("Chains, trees and loops are eliminated as dense matrices are", "[complex_elimination]") {
  const std::vector<std::pair<int, int>> chain{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}};
  const std::vector<std::pair<int, int>> tree{{3, 0}, {3, 1}, {3, 2}, {3, 4}, {4, 5}, {4, 6}};
  const std::vector<std::pair<int, int>> loops{{0, 1}, {1, 2}, {2, 0}, {2, 3},
                                               {3, 4}, {4, 1}, {5, 0}, {5, 3}};
  for (const double w : {1.0, 9.0, 31.0}) {
    check_against_dense(Matrices(6, chain, 1e-3), {0.0, w}, 1e-13);
    check_against_dense(Matrices(7, tree, 1e-3), {0.0, w}, 1e-13);
    check_against_dense(Matrices(6, loops, 1e-3), {-0.4, w}, 1e-13);
  }
}

TEST_CASE("A pivot lost at an antiresonance does not spoil the solution", "[complex_elimination]") {
  // The end of the chain swings against its spring alone: its pivot is zero.
  Matrices a(3, {{0, 1}, {1, 2}}, 0.0);
  const double w = std::sqrt(a.k[a.place(0, 0)] / a.m[a.place(0, 0)]);
  REQUIRE(std::abs(a.at({0.0, w})(0, 0)) < 1e-12);
  check_against_dense(a, {0.0, w}, 1e-12);
}

TEST_CASE("Sets of eight frequencies are solved as dense matrices are, a lost pivot is told",
          "[complex_elimination]") {
  constexpr int kSets = 3;
  const Matrices a(6, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 1}, {5, 0}, {5, 3}}, 1e-3),
      undamped(3, {{0, 1}, {1, 2}}, 0.0);
  for (const Matrices* m : {&a, &undamped}) {
    const Eigen::Index n = m->pattern.rows(), values = m->k.size();
    const ComplexElimination plan(m->pattern);
    LaneElimination lanes(plan);
    const auto row = [](Eigen::Index i, int set) { return static_cast<std::size_t>(i * kLaneSets + set); };
    LaneArray b_re(row(n, 0)), b_im(row(n, 0)), re(row(n, 0)), im(row(n, 0)), w(kLaneSets), lost(kLaneSets);
    const auto b = [](Eigen::Index i, int set) {
      return Complex(1.0 + static_cast<double>(i), -0.3 * static_cast<double>(i) + set);
    };
    for (int set = 0; set < kSets; ++set) {
      for (Eigen::Index i = 0; i < n; ++i) {
        b_re[row(i, set)].v = Lanes{} + b(i, set).real();
        b_im[row(i, set)].v = Lanes{} + b(i, set).imag();
      }
      w[static_cast<std::size_t>(set)].v =
          Lanes{1.0, -1.0, 4.0, 9.0, 12.0, 20.0, 31.0, 55.0} * (1.0 + 0.1 * set);
    }
    // The end of the undamped chain swings against its spring alone: its pivot is zero.
    if (m == &undamped) w[1].v[3] = std::sqrt(m->k[m->place(0, 0)] / m->m[m->place(0, 0)]);
    // A loss factor of every stiffness but where the pivot is to be lost; the same values common and by lanes.
    const double factor = m == &undamped ? 0.0 : 0.07;
    const Vector h = factor * m->k;
    LaneArray k_lanes(row(values, 0)), h_lanes(row(values, 0));
    for (Eigen::Index i = 0; i < values; ++i)
      for (int set = 0; set < kSets; ++set)
        k_lanes[row(i, set)].v = Lanes{} + m->k[i], h_lanes[row(i, set)].v = Lanes{} + h[i];
    for (const bool by_lanes : {false, true}) {
      for (LaneArray* x : {&re, &im, &lost}) std::fill(x->begin(), x->end(), LaneRow{});
      if (by_lanes)
        lanes.solve(kSets, LaneDynamics<LaneRow>{m->m.data(), m->c.data(), k_lanes.data(), h_lanes.data()},
                    w.data(), b_re.data(), b_im.data(), re.data(), im.data(), lost.data());
      else
        lanes.solve(kSets, LaneDynamics<double>{m->m.data(), m->c.data(), m->k.data(), h.data()}, w.data(),
                    b_re.data(), b_im.data(), re.data(), im.data(), lost.data());
      for (int set = 0; set < kSets; ++set)
        for (int lane = 0; lane < kLanes; ++lane) {
          const auto s = static_cast<std::size_t>(set);
          INFO("w = " << w[s].v[lane]);
          const bool expected_lost = m == &undamped && set == 1 && lane == 3;
          CHECK((lost[s].v[lane] != 0.0) == expected_lost);
          if (expected_lost) continue;
          Eigen::VectorXcd given(n);
          for (Eigen::Index i = 0; i < n; ++i) given[i] = b(i, set);
          Eigen::MatrixXcd matrix = m->at({0.0, w[s].v[lane]});
          matrix += Complex(0.0, factor) * m->at({0.0, 0.0});
          const Eigen::VectorXcd x = lu_solve(matrix, given);
          for (Eigen::Index i = 0; i < n; ++i)
            CHECK(std::abs(Complex(re[row(i, set)].v[lane], im[row(i, set)].v[lane]) - x[i]) <
                  1e-11 * x.norm());
        }
    }
  }
}
