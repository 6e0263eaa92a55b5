#include <drev/core/error.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

/// Of each kind of channel the model's `which`-th that moves.
std::vector<std::size_t> one_of_each_kind(const ReferenceModel& model, const ReferenceResult& r,
                                          std::size_t which) {
  std::map<ChannelId::Kind, std::vector<std::size_t>> by_kind;
  for (std::size_t c = 0; c < model.channels().size(); ++c)
    if (r.peaks[c].amplitude() > 0) by_kind[model.channels()[c].kind].push_back(c);
  std::vector<std::size_t> chosen;
  for (const auto& [kind, all] : by_kind) chosen.push_back(all[which % all.size()]);
  return chosen;
}

double seconds(Real t) { return static_cast<double>(t); }

/// Contact changes: as many as stated, and the first and the last comparable one at the times stated.
void compare_edges(const Case& c, const drev::AccuracyResult& result, const std::string& where,
                   const std::string& by, Table& table) {
  const std::vector<EdgeTime>&truth = c.fine.edges, &check = c.check.edges;
  const auto error = [&](std::size_t i) {
    return i < check.size() ? 2.0 * std::abs(seconds(truth[i].t - check[i].t)) + 1e-18 : 1e300;
  };
  for (const drev::Figure& f : result.figures) {
    if (f.kind != drev::Estimate::Kind::estimate) continue;
    if (f.name == "contact changes")
      table.add(by + "contact changes",
                {where, f.value, f.error, static_cast<double>(truth.size()),
                 2.0 * std::abs(static_cast<double>(truth.size()) - static_cast<double>(check.size()))});
    const bool first = f.name == "first contact change", last = f.name == "last comparable contact change";
    if ((!first && !last) || truth.empty()) continue;
    // Of the change nearest to it: whether one was missed is the number's affair.
    const auto nearest =
        std::min_element(truth.begin(), truth.end(), [&](const EdgeTime& a, const EdgeTime& b) {
          return std::abs(a.t - static_cast<Real>(f.value)) < std::abs(b.t - static_cast<Real>(f.value));
        });
    const auto i = first ? 0 : static_cast<std::size_t>(nearest - truth.begin());
    table.add(by + (first ? "time of first contact change" : "time of last comparable contact change"),
              {where, f.value, f.error, seconds(truth[i].t), error(i)});
  }
}

}  // namespace

void cover_accuracy(const Case& c, const Asked& asked, Table& table) {
  const ReferenceModel model(c.spec);
  const drev::System system = to_drev(c.spec);
  std::vector<std::size_t> channels = one_of_each_kind(model, c.fine, asked.which);
  if (channels.empty()) return;
  std::rotate(channels.begin(),
              channels.begin() + static_cast<std::ptrdiff_t>((asked.which * 5) % channels.size()),
              channels.end());
  const bool exact = asked.method == drev::kExact;
  std::ostringstream text;
  text << c.spec.name << " (" << c.spec.family << "), " << asked.method << " to " << asked.accuracy;
  const std::string where = text.str(), by = exact ? "accuracy: " : "accuracy by steps: ";
  for (std::size_t i = 0; i < static_cast<std::size_t>(asked.pairs) && 2 * i < channels.size(); ++i) {
    const std::size_t a = channels[2 * i], b = channels[(2 * i + 1) % channels.size()];
    drev::AccuracyResult result;
    try {
      result = drev::run_to_accuracy(
          system, {.accuracy = asked.accuracy,
                   .t_end = c.spec.duration,
                   .deflection = model.channels()[a].name,
                   .torques = {model.channels()[b].name},
                   .method = {.name = asked.method, .tolerance = exact ? 0.0 : asked.accuracy},
                   .most_seconds = 2.0});
    } catch (const drev::SolverError& e) {
      table.add_claim(by + "the run ends", where + " " + e.what(), false);
      continue;
    }
    table.add_claim(by + "the run ends", where + " " + result.summary.reason, result.summary.ok());
    if (!result.summary.ok()) continue;
    bool true_to_word = true;
    for (const drev::Figure& f : result.figures) {
      if (f.kind != drev::Estimate::Kind::estimate) continue;
      const bool first = f.name == "peak deflection";
      if (!first && f.name != "peak torque") continue;
      const std::size_t channel = first ? a : b;
      const double truth = static_cast<double>(c.fine.peaks[channel].amplitude());
      table.add(
          by + "peak [" + to_text(model.channels()[channel].kind) + "]",
          {where + " " + model.channels()[channel].name, f.value, f.error, truth, c.truth_error(channel)});
      if (std::abs(f.value - truth) > asked.accuracy * f.scale + c.truth_error(channel)) true_to_word = false;
    }
    compare_edges(c, result, where, by, table);
    if (result.reached) table.add_claim(by + "reached", where, true_to_word);
  }
}

}  // namespace coverage
