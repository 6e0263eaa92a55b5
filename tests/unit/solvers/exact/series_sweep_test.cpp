// Sweeps of forces on few rows beside powers of the dense matrix, for chains and trees of several sizes.
// Covers solvers/series/series_sweep.cpp and, through it, series_kernels.hpp.
#include <drev/elements/catalogue.hpp>

#include <Eigen/Dense>
#include <random>

#include "solvers/series/series_kernels.hpp"
#include "solvers/series/taylor_series.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

enum class Shape { chain, branch, ladder };

/// Discs on shafts one behind the other from the ground on: alone; with one shaft that leads back; or with many.
Model discs(int count, Shape shape, bool shafts_damp) {
  Model m("discs");
  const auto node = [](int i) { return "n" + std::to_string(i); };
  for (int i = 0; i < count; ++i) {
    m.add_node(node(i));
    m.add<Inertia>("J" + node(i), {node(i)}, {.inertia = 0.1 + 0.01 * (i % 7)});
    m.add<GroundSpring>("c" + node(i), {node(i)}, {.stiffness = i == 0 ? 2e4 : 10.0, .damping = 1.0 + i % 3});
    if (i > 0)
      m.add<ShaftSpring>("k" + node(i), {node(i - 1), node(i)},
                         {.stiffness = 2e4 + 300.0 * (i % 5), .damping = shafts_damp ? 2.0 : 0.0});
  }
  if (shape != Shape::chain)
    for (int i = 0; i + count / 2 < count; i += shape == Shape::branch ? count : 1)
      m.add<ShaftSpring>("back" + node(i), {node(i), node(i + count / 2)}, {.stiffness = 1e4});
  return m;
}

Eigen::MatrixXd dense(const System& system, const Vector& values) {
  SparseMatrix m = system.pattern();
  std::copy(values.begin(), values.end(), m.valuePtr());
  return m;
}

}  // namespace

TEST_CASE("A sweep of forces on few rows is the dense matrix's series, whatever the layout") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> size(-1.0, 1.0);
  for (const int count : {3, 8, 13, 39, 40, 47, 48, 60})
    for (const Shape shape : {Shape::chain, Shape::branch, Shape::ladder})
      for (const bool shafts_damp : {false, true}) {
        const System system = discs(count, shape, shafts_damp).build();
        const double h = 3.0 / 900.0;
        TaylorSeries series(system);
        series.bound_rates();
        series.reset();
        REQUIRE(series.expand(Vector::Ones(count), Vector::Ones(count), h, 1e-12) == h);
        const Eigen::MatrixXd inverse = dense(system, system.mass_values()).inverse();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * count, 2 * count);  // A of (y, u), u by s
        a.topRightCorner(count, count).setIdentity();
        a.bottomLeftCorner(count, count) = -h * h * inverse * dense(system, system.stiffness_values());
        a.bottomRightCorner(count, count) = -h * inverse * dense(system, system.damping_values());
        for (const auto& [forces, degree] : {std::pair(1, 17),
                                             {8, 8},
                                             {9, 17},
                                             {15, 12},
                                             {16, 17},
                                             {23, 17},
                                             {3, 9},
                                             {3, 10},
                                             {3, 11},
                                             {3, 28}}) {
          if (forces > count) continue;
          for (const bool own_rows : {true, false}) {
            INFO(count << " discs, shape " << static_cast<int>(shape) << ", " << forces << " forces, degree "
                       << degree << (own_rows ? "" : " on shared rows"));
            const int step = whole_lanes(forces);
            std::vector<int> rows;
            LaneVector values(static_cast<std::size_t>((degree + 1) * step));
            Eigen::MatrixXd w = Eigen::MatrixXd::Zero(2 * count, degree + 1);
            for (int i = 0; i < forces; ++i) {
              rows.push_back(own_rows ? (i * 5) % count : i % 2);
              if (own_rows && std::count(rows.begin(), rows.end(), rows.back()) > 1) rows.back() = -1;
            }
            // Rows that a step of 5 did not reach, where it divides the count.
            for (int& row : rows)
              for (int free = 0; row < 0; ++free)
                if (std::find(rows.begin(), rows.end(), free) == rows.end()) row = free;
            for (int i = 0; i < forces; ++i) {
              double factorial = 1.0;
              for (int j = 0; j <= degree; factorial *= ++j + 1) {
                const double moment = 500.0 * size(random) / factorial;
                values[static_cast<std::size_t>(j * step + i)] = moment;
                w.col(j).tail(count) += h * h * moment * inverse.col(rows[static_cast<std::size_t>(i)]);
              }
            }
            const long before = series.products();
            series.sweep({forces, rows.data(), values.data(), step, own_rows}, degree);
            CHECK(series.products() - before == degree + 1);
            for (int part = 0; part < TaylorSeries::kSweptParts; ++part) {
              Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * count);
              for (int j = degree; j >= part; --j) y = a * y + w.col(j);
              const auto found = Eigen::Map<const Vector>(series.swept(part), count);
              CHECK((found - y.head(count)).norm() < 1e-13 * y.norm());
              if (part > 0) continue;
              CHECK((Eigen::Map<const Vector>(series.swept(-1), count) - y.tail(count)).norm() <
                    1e-13 * y.norm());
            }
          }
        }
      }
}

TEST_CASE("The end of a step: sums of its terms, with what was swept on top, for any number of unknowns") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const int n : {1, 7, 8, 9, 39, 40, 41, 90}) {
    const int stride = (n + kLanes - 1) / kLanes * kLanes, degree = 11;
    LaneVector terms(static_cast<std::size_t>((degree + 1) * stride)),
        y(static_cast<std::size_t>(2 * stride)), sums(static_cast<std::size_t>(2 * stride), -7.0);
    for (double& term : terms) term = any(random);
    for (double& value : y) value = any(random);
    sum_terms(stride, degree, terms.data() + stride, sums.data() + stride, sums.data());
    const std::size_t room = static_cast<std::size_t>(n) + 1;
    for (const bool swept : {false, true}) {
      std::vector<double> z(room, 3.0), v(room, 3.0);
      end_motion(n, terms.data(), sums.data(), sums.data() + stride, 50.0, swept ? y.data() : nullptr,
                 swept ? y.data() + stride : nullptr, z.data(), v.data());
      for (int i = 0; i < n; ++i) {
        long double value = swept ? y[static_cast<std::size_t>(i)] : 0.0L,
                    rate = swept ? y[static_cast<std::size_t>(stride + i)] : 0.0L;
        for (int k = 0; k <= degree; ++k) {
          value += terms[static_cast<std::size_t>(k * stride + i)];
          rate += static_cast<long double>(k) * terms[static_cast<std::size_t>(k * stride + i)];
        }
        CHECK(z[static_cast<std::size_t>(i)] == Approx(static_cast<double>(value)).margin(1e-14));
        CHECK(v[static_cast<std::size_t>(i)] == Approx(static_cast<double>(50.0L * rate)).margin(1e-11));
      }
      CHECK(z.back() == 3.0);  // nothing behind the last one
      CHECK(v.back() == 3.0);
    }
  }
}
