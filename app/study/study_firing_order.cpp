// Tables 5.9 and 5.10: firing orders of 6 and 8 cylinders; the whole set searched.
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/base/text_layout.hpp"
#include "app/chart/svg_chart.hpp"
#include "app/study/study_runs.hpp"
#include "models/camshaft/published.hpp"
#include "models/camshaft/steady_shaft.hpp"

namespace drev::app {

namespace {

constexpr const char* kDamping = "case_3";  // see how()
constexpr double kLowEffect = 2.0;          // times the best order's deflection

using Waves = SteadyShaft::Waves;
using Order = std::vector<int>;

std::string order_text(const Order& order) {
  std::vector<std::string> items;
  for (const int k : order) items.push_back(std::to_string(k));
  return join(items, "-");
}

struct Steady {
  Order order;
  double deflection = 0.0, torque = 0.0;  // deg, N m
};

Steady steady_of(const std::vector<Waves>& waves, const Order& order) {
  const Waves all = in_order(waves, order, 0, waves.front().cols());
  Steady result{order, to_deg(peak_of(all.col(0)))};
  for (Eigen::Index c = 1; c < all.cols(); ++c) result.torque = std::max(result.torque, peak_of(all.col(c)));
  return result;
}

/// Every order that begins with cylinder 1, by deflection.
std::vector<Steady> search(const std::vector<Waves>& waves) {
  Order order(waves.size());
  std::iota(order.begin(), order.end(), 1);
  std::vector<Steady> all;
  do all.push_back({order});
  while (std::next_permutation(order.begin() + 1, order.end()));
  // A quarter of the samples finds the place in the list.
  std::vector<Waves> thin;
  for (const Waves& w : waves) thin.push_back(w(Eigen::seqN(0, w.rows() / 4, 4), Eigen::all));
  for_all(all.size(), [&](std::size_t i) { all[i] = steady_of(thin, all[i].order); });
  std::sort(all.begin(), all.end(),
            [](const Steady& a, const Steady& b) { return a.deflection < b.deflection; });
  return all;
}

/// The part that repeats with every cylinder, the same in all orders: peak [deg].
double common_part(const std::vector<Waves>& waves) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(waves.front().rows());
  const auto count = static_cast<Eigen::Index>(waves.size());
  Order order(waves.size());
  std::iota(order.begin(), order.end(), 1);
  const Eigen::VectorXd all = in_order(waves, order, 0, 1).col(0);
  const Eigen::Index n = sum.size();
  for (Eigen::Index j = 0; j < count; ++j)
    for (Eigen::Index i = 0; i < n; ++i) sum[i] += all[(i + j * n / count) % n] / static_cast<double>(count);
  return to_deg(peak_of(sum));
}

double worst_reversal(const std::vector<Steady>& all) {
  double worst = 0.0;
  for (const Steady& s : all) {
    Order reversed = s.order;
    std::reverse(reversed.begin() + 1, reversed.end());
    const auto other =
        std::find_if(all.begin(), all.end(), [&](const Steady& o) { return o.order == reversed; });
    worst = std::max(worst, std::abs(other->deflection / s.deflection - 1.0));
  }
  return worst;
}

struct Search {
  StudyTable table;
  std::string verdict, symmetry, effect;
};

template <std::size_t N>
Search search_orders(int cylinders, const std::string& source,
                     const std::array<published::FiringOrder, N>& orders) {
  const SteadyShaft shaft(cylinders);
  const std::vector<Waves> waves =
      shaft.cylinder_waves(rpm(0.5 * published::kEngineRpm), rayleigh_case(kDamping, cylinders));
  const std::vector<Steady> all = search(waves);
  const auto by_torque = [](const Steady& a, const Steady& b) { return a.torque < b.torque; };
  const Steady& lightest = *std::min_element(all.begin(), all.end(), by_torque);

  struct Shown {
    std::string order, deflection, torque, note;
  };
  std::vector<Shown> shown;
  for (const auto& p : orders) shown.push_back({p.order, printed(p.deflection), printed(p.torque), ""});
  shown.push_back({order_text(all[0].order), "-", "-", "least steady deflection of all; "});
  shown.push_back({order_text(lightest.order), "-", "-", "least steady torque of all; "});
  const std::string default_order = order_text(default_firing_order(cylinders));
  std::vector<ParameterValues> cases;
  for (const Shown& s : shown)
    cases.push_back({{"cylinders", std::to_string(cylinders)},
                     {"drive", "held"},
                     {"damping", kDamping},
                     {"firing_order", s.order == default_order ? "default" : s.order}});
  const std::vector<CamshaftCase> runs = run_cases(cases, 2);

  Search result{{std::to_string(cylinders) + " cylinders"}, {}, {}, {}};
  std::vector<Steady> exact;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const Steady& s) { return order_text(s.order) == shown[i].order; });
    exact.push_back(steady_of(waves, at->order));
    const std::string rank = std::to_string(at - all.begin() + 1) + " of " + std::to_string(all.size());
    result.table.rows.push_back(
        {i < N ? source : "-", shown[i].order + ", deflection", "deg", shown[i].deflection,
         runs[i].step_cell(&CamshaftFigures::deflection), runs[i].deflection(),
         shown[i].note + "steady " + digits(exact.back().deflection, 4) + ", rank " + rank});
    result.table.rows.push_back({i < N ? source : "-", shown[i].order + ", torque", "N m", shown[i].torque,
                                 runs[i].step_cell(&CamshaftFigures::torque), runs[i].torque(),
                                 "steady " + cell(exact.back().torque)});
  }
  const std::string n = std::to_string(cylinders);
  result.verdict = n + " cylinders, steady state: the best order is " + shown[N].order + " with " +
                   digits(exact[N].deflection, 3) + " deg, the source's " + shown[0].order + " has " +
                   digits(exact[0].deflection, 3) + " deg, the worst of all " + order_text(all.back().order) +
                   " " + digits(all.back().deflection, 3) + " deg. The least torque, " +
                   digits(exact[N + 1].torque, 4) + " N m, has " + shown[N + 1].order +
                   "; the source's order has " + digits(exact[0].torque, 4) + " N m.";
  const double range = all.back().deflection / all[0].deflection;
  const int strongest =
      largest_orders(in_order(waves, default_firing_order(cylinders), 0, 1).col(0))[0].second;
  result.effect =
      "With " + n + " cylinders the worst order has " + digits(range, 2) +
      " times the deflection of the best: **it " + stands(range < kLowEffect) + "**" +
      (range < kLowEffect && strongest % cylinders == 0 ? ", but for another reason" : "") +
      "; the largest part of the deflection has the frequency of order " + std::to_string(strongest) +
      (strongest % cylinders == 0 ? ", a multiple of " + n +
                                        " and therefore the same in every firing order, which "
                                        "cannot detune it."
                                  : ", no multiple of " + n + ": the firing order sets its size.");
  result.symmetry = n + " cylinders: " + std::to_string(all.size()) +
                    " orders; reversing an order changes the deflection by up to " +
                    digits(100.0 * worst_reversal(all), 2) +
                    " %; the part that is the same in all orders has a peak of " +
                    digits(common_part(waves), 3) + " deg, below which no order can come";
  return result;
}

}  // namespace

StudyGroup study_firing_order() {
  StudyGroup group{.title = "Firing order"};
  group.how =
      "Gear held at 750 rpm, loads at the nominal angle. The damping of Tables 5.9 and 5.10 is not "
      "printed; case 3 "
      "is nearest to their first rows. Rows: largest over 5 s from rest, as printed; steady: of a "
      "revolution when "
      "the start has died out, which is what orders are ranked by, over all that are worth it.";
  const Search six = search_orders(6, "Table 5.9", published::kOrders6);
  const Search eight = search_orders(8, "Table 5.10", published::kOrders8);
  group.tables = {six.table, eight.table};
  group.verdicts = {
      "How few orders there are: the loads are known in time, so that the steady state is the sum "
      "of the "
      "cylinders' own, each shifted by its place. Shifting all is a shift of time: cylinder 1 may "
      "fire first, "
      "(N - 1)! orders are left. Reversal is no further symmetry, since the three cams of a "
      "cylinder do not look "
      "the same backwards and damping has a sense of time. " +
          six.symmetry + ". " + eight.symmetry + ".",
      six.verdict + " " + eight.verdict,
      "\"The effect of firing orders is lower than expected, because the pumps' short impulses "
      "dominate\". " +
          six.effect + " " + eight.effect};
  return group;
}

}  // namespace drev::app
