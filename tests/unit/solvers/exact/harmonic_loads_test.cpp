// Loads that are smooth: sums of harmonics by rotation and by polynomials in cells, against cosines term by term in
// long double; and exact propagation under many orders, against the same torque as a function nothing is known of.
// Covers core/law/harmonic_load.hpp, core/law/orders.hpp, solvers/exact/harmonic_cells.hpp, expanded_loads.hpp and lane_pair.hpp.
#include <drev/core/element.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "solvers/exact/harmonic_cells.hpp"
#include "solvers/series/series_kernels.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

std::vector<Harmonic> harmonics(double spacing, int count) {
  std::vector<Harmonic> all;
  for (int i = 1; i <= count; ++i) all.push_back({spacing * i, 100.0 / i, 0.7 * i});
  return all;
}

CurvePoint term_by_term(const std::vector<Harmonic>& all, double mean, double angle) {
  long double value = mean, slope = 0.0L;
  for (const Harmonic& h : all) {
    const long double argument = static_cast<long double>(h.order) * angle + h.phase;
    value += h.amplitude * std::cos(argument);
    slope -= h.amplitude * h.order * std::sin(argument);
  }
  return {static_cast<double>(value), static_cast<double>(slope)};
}

/// The same torque as an EngineOrderTorque, of which it says nothing.
class Opaque final : public Element, public Load {
 public:
  using Params = EngineOrderTorque::Params;
  explicit Opaque(const Params& params) : torque_(params) {}
  std::string_view type() const override { return "opaque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override { return torque_.evaluate(in); }

 private:
  EngineOrderTorque torque_;
};

template <class Torque>
System two_discs(bool twist_feedback) {
  Model m("two discs");
  for (const char* node : {"crank", "wheel", "load"}) m.add_node(node);
  m.constant_speed("load", 80.0);
  m.add<Inertia>("J_crank", {"crank"}, {.inertia = 0.1});
  m.add<Inertia>("J_wheel", {"wheel"}, {.inertia = 0.4});
  m.add<ShaftSpring>("crankshaft", {"crank", "wheel"}, {.stiffness = 5e5, .damping = 10.0});
  m.add<ShaftSpring>("coupling", {"wheel", "load"}, {.stiffness = 2e4});
  m.add<Torque>("gas", {"crank"},
                {.harmonics = harmonics(0.5, 40), .mean = 30.0, .twist_feedback = twist_feedback});
  return m.build();
}

}  // namespace

TEST_CASE("A sum of harmonics by rotation is that of its terms, whatever the spacing of the orders") {
  std::vector<Harmonic> uneven{{0.5, 3.0, 0.1}, {7.25, -2.0, 1.0}, {3.0, 5.0, 2.0}, {3.3, 1.0, -1.0}};
  for (const auto& all : {harmonics(1.0, 77), harmonics(0.5, 24), uneven}) {
    const EngineOrderTorque torque({.harmonics = all, .mean = -4.0});
    for (const double angle : {0.0, 0.3, -2.0, 11.7, 1234.5}) {
      const CurvePoint expected = term_by_term(all, -4.0, angle);
      const LoadResponse r = torque.evaluate({.nominal_angle = angle});
      CHECK(r.torque == Approx(expected.value).margin(1e-12 * (1.0 + std::abs(angle)) * 100.0));
      CHECK(r.dtorque_dangle == Approx(expected.slope).margin(1e-12 * (1.0 + std::abs(angle)) * 7700.0));
    }
  }
}

TEST_CASE("Harmonics in cells: value and slope at every angle, with and without a common period") {
  std::vector<Harmonic> aperiodic{{1.0, 3.0, 0.1}, {std::sqrt(2.0), -2.0, 1.0}, {12.3, 5.0, 2.0}};
  for (const auto& all : {harmonics(1.0, 77), harmonics(0.5, 24), aperiodic}) {
    const EngineOrderTorque torque({.harmonics = all, .mean = -4.0});
    HarmonicCells cells(torque.orders());
    for (int i = -500; i < 500; ++i) {
      const double angle = 0.0173 * i;
      const CurvePoint expected = term_by_term(all, -4.0, angle);
      const LoadResponse r = HarmonicCells::value(cells.at(angle));
      INFO("angle " << angle << " rad");
      CHECK(std::abs(r.torque - expected.value) <= 1e-11);
      CHECK(std::abs(r.dtorque_dangle - expected.slope) <= 1e-9);
      // As far as it says that it holds, in the next cell too.
      const HarmonicCells::Place place = cells.at(angle);
      const double beside = std::copysign(cells.reach(), place.distance) - place.distance;
      const double there = term_by_term(all, -4.0, angle + beside).value;
      CHECK(std::abs(HarmonicCells::value({place.cell, place.distance + beside}).torque - there) <= 1e-10);
    }
  }
}

TEST_CASE("Exact propagation under engine orders: as under a function of which nothing is known") {
  for (const bool feedback : {true, false}) {
    const System known = two_discs<EngineOrderTorque>(feedback), opaque = two_discs<Opaque>(feedback);
    State a = State::initial(known), b = State::initial(opaque);
    const RunSummary with = propagate(known, {.tolerance = 1e-11, .t_end = 0.3}, a);
    const RunSummary without = propagate(opaque, {.tolerance = 1e-11, .t_end = 0.3}, b);
    CHECK(with.ok());
    CHECK(without.ok());
    CHECK((a.z - b.z).lpNorm<Eigen::Infinity>() <= 1e-10 * b.z.lpNorm<Eigen::Infinity>());
    CHECK((a.v - b.v).lpNorm<Eigen::Infinity>() <= 1e-10 * b.v.lpNorm<Eigen::Infinity>());
    CHECK(std::abs(with.energy.relative_error()) < 1e-11);
    CHECK(10 * with.steps <= 11 * without.steps);
    // The fastest mode, 2,501 rad/s, bounds the steps, and not the orders: 20 x 80 rad/s at most.
    CHECK(with.steps <= 750);
  }
}

TEST_CASE("A series at many places at once is what it is at each") {
  constexpr int n = 2 * kLanes, degree = 13;
  std::vector<double> z(static_cast<std::size_t>(n * (degree + 1)));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::sin(1.0 + 0.37 * static_cast<double>(i));
  const std::array<double, 4> s{0.0, 0.25, 0.8, 1.0};
  std::vector<double> values(4 * n), rates(4 * n), value(n), rate(n);
  series_at_nodes(n, degree, z.data(), s.data(), 4, values.data(), rates.data());
  for (std::size_t q = 0; q < 4; ++q) {
    series_values(n, degree, z.data(), s[q], value.data(), rate.data());
    for (std::size_t i = 0; i < n; ++i) {
      CHECK(values[q * n + i] == Approx(value[i]).epsilon(1e-13));
      CHECK(rates[q * n + i] == Approx(rate[i]).epsilon(1e-12));
    }
  }
}
