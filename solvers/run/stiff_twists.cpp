#include "solvers/run/stiff_twists.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace drev {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kStiff = 1e9;       // N m/rad or N/m: softer elements lose nothing at any angle in use
constexpr double kPrinted = 1e-5;    // of the largest torque: five digits
constexpr double kDeviations = 4.0;  // standard deviations of the walk that are stated
constexpr long kOfEach = 256;        // steps looked at before only every other one of them is

/// The rounding that one evaluation of a linear channel carries at a state, of the channel's unit: epsilon times the
/// sum of the sizes of its terms; 0 for channels that are not linear.
double rounding_of(const Channel& channel, const State& state) {
  if (!channel.is_linear()) return 0.0;
  double sum = 0.0;
  for (const Entry& e : channel.z_row()) sum += std::abs(e.coeff * state.z[e.index]);
  return kEpsilon * sum;
}

}  // namespace

StiffTwists::StiffTwists(const System& system) {
  for (Channel& channel : all_channels(system)) {
    double stiffness = 0.0;
    if (channel.is_linear() && !channel.value_needs_acceleration())
      for (const Entry& e : channel.z_row()) stiffness = std::max(stiffness, std::abs(e.coeff));
    if (stiffness >= kStiff) watched_.push_back({std::move(channel)});
  }
}

void StiffTwists::step(const Assembler& assembler, const EvaluatedState&, const EvaluatedState& to) {
  if (due()) look(assembler, to);
}

bool StiffTwists::due() {
  if (watched_.empty() || ++steps_ % stride_ != 0) return false;
  if (++taken_ % kOfEach == 0) stride_ *= 2;
  return true;
}

void StiffTwists::look(const Assembler& assembler, const EvaluatedState& point) {
  for (Watched& w : watched_) {
    w.largest = std::max(w.largest, std::abs(w.channel.evaluate(assembler, point.state)));
    w.rounding = std::max(w.rounding, rounding_of(w.channel, point.state));
  }
}

void StiffTwists::warn(RunSummary& summary) const {
  const double walk = std::sqrt(static_cast<double>(std::max(1L, summary.steps)));
  const Watched* worst = nullptr;
  int others = -1;
  for (const Watched& w : watched_) {
    if (!(w.rounding * walk > kPrinted * w.largest)) continue;
    ++others;
    summary.rounding.emplace_back(w.channel.name(), kDeviations * w.rounding * walk);
    if (!worst || w.rounding * worst->largest > worst->rounding * w.largest) worst = &w;
  }
  if (!worst) return;
  const std::string& name = worst->channel.name();
  std::ostringstream text;
  text.precision(2);
  text << name.substr(0, name.find('.'))
       << " is so stiff that rounding of its angles leaves an error of up to "
       << kDeviations * worst->rounding * walk << " " << worst->channel.unit() << " in its " << worst->largest
       << " " << worst->channel.unit();
  if (others > 0) text << ", and so are " << others << " more elements";
  text << "; make it an ideal coupling (one node, or ideal_gear), or take a stiffness that matters";
  summary.warnings.push_back(text.str());
}

}  // namespace drev
