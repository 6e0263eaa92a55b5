// The best firing order of 9 cylinders, found and proved over all 40,320 that begin with cylinder 1.
#include <drev/core/units.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>

#include "models/camshaft/steady_shaft.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

struct RankedOrder {
  std::vector<int> order;
  double deflection = 0.0;  // deg
};

std::string text_of(const std::vector<int>& order) {
  std::string text;
  for (const int k : order) text += (text.empty() ? "" : "-") + std::to_string(k);
  return text;
}

/// By harmonic balance over the whole model, which knows nothing of superposition [deg].
double by_harmonic_balance(const std::vector<int>& order) {
  const ModelCase model_case = build_case("camshaft", {{"drive", "held"},
                                                       {"damping", "case_3"},
                                                       {"loads", "source"},
                                                       {"engine_rpm", "750"},
                                                       {"firing_order", text_of(order)}});
  const PeriodicResponse found =
      solve_periodic(model_case.model.build(), {.channels = {model_case.deflection}});
  REQUIRE(found.found);
  return to_deg(found.peaks[0].amplitude());
}

}  // namespace

TEST_CASE("The best firing order of 9 cylinders among all 40,320", "[once]") {
  const std::vector<SteadyShaft::Waves> waves =
      SteadyShaft(9).cylinder_waves(rpm(375.0), rayleigh_case("case_3", 9));
  // A peak between samples is found by a parabola: every fourth sample sorts the orders to within `rough`.
  std::vector<SteadyShaft::Waves> thin;
  for (const auto& w : waves) thin.push_back(w(Eigen::seqN(0, w.rows() / 4, 4), Eigen::seqN(0, 1)));
  std::vector<RankedOrder> all;
  std::vector<int> order{1, 2, 3, 4, 5, 6, 7, 8, 9};
  do all.push_back({order, to_deg(peak_of(in_order(thin, order, 0, 1).col(0)))});
  while (std::next_permutation(order.begin() + 1, order.end()));
  REQUIRE(all.size() == 40320);
  const auto less = [](const RankedOrder& a, const RankedOrder& b) { return a.deflection < b.deflection; };
  std::sort(all.begin(), all.end(), less);
  const RankedOrder worst = all.back();
  constexpr std::size_t kLooked = 200;
  const double beyond = all[kLooked].deflection;  // no order after these is better on rough samples
  double rough = 0.0;
  for (std::size_t i = 0; i < kLooked; ++i) {
    const double fine = to_deg(peak_of(in_order(waves, all[i].order, 0, 1).col(0)));
    rough = std::max(rough, std::abs(fine - all[i].deflection));
    all[i].deflection = fine;
  }
  std::sort(all.begin(), all.begin() + kLooked, less);
  CHECK(text_of(all[0].order) == "1-2-3-9-8-7-6-4-5");
  CHECK(all[0].deflection == Approx(0.592594).epsilon(1e-6));
  CHECK(all[1].deflection > all[0].deflection + 4.0 * rough);
  CHECK(all[0].deflection < beyond - 4.0 * rough);
  CHECK(by_harmonic_balance(all[0].order) == Approx(all[0].deflection).epsilon(1e-5));
  const double source = to_deg(peak_of(in_order(waves, default_firing_order(9), 0, 1).col(0)));
  CHECK(source == Approx(1.149335).epsilon(1e-6));
  CHECK(worst.deflection == Approx(1.443612).epsilon(1e-4));
}
