#include <drev/core/control/controllers.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>

#include <algorithm>
#include <sstream>

#include "solvers/reduction/truncation_error.hpp"

namespace drev {

namespace {

constexpr int kGrowthPieces = 100;

std::string percent_text(double part) {
  std::ostringstream text;
  text.precision(2);
  text << 100.0 * part << " %";
  return text.str();
}

/// A channel that modal_shares() refuses.
const Channel* first_without_estimate(const std::vector<Channel>& channels) {
  for (const Channel& c : channels)
    if (!c.is_linear() && c.force_of() < 0 && c.deflection_of() < 0) return &c;
  return nullptr;
}

/// What choose_reduction() chooses for `target`, tried.
ReductionTrial try_choice(const System& system, const TrialOptions& o, double target) {
  ReductionTrial trial{.method = o.method};
  const auto refuse = [&](std::string reason) {
    trial.reason = "not reduced: " + std::move(reason);
    return trial;
  };
  if (const auto why = why_not_friction(system, "a reduction")) return refuse(*why);
  if (const auto why = why_not_controllers(system, "a reduction")) return refuse(*why);
  const std::vector<Channel> channels = find_channels(system, o.channels);
  if (const Channel* unknown = first_without_estimate(channels))
    return refuse("the error of " + unknown->name() + " cannot be estimated");
  ReductionChoice choice;
  try {
    choice = choose_reduction(system, target, o.channels, o.duration);
  } catch (const SolverError& error) {
    return refuse(error.what());
  }
  if (!choice.reduction) {
    trial.reason = choice.reason;
    return trial;
  }
  const System& reduced = choice.reduction->system;
  const Method method = o.any_method ? choose_method(reduced, o.duration, o.method.step).method : o.method;
  try {
    TruncationError left_out(system, *choice.reduction, o.channels);
    const RunSummary run =
        run_method(reduced, method, {.t_end = o.duration, .progress = o.progress}, {&left_out});
    if (!run.ok())
      return refuse(std::string("its trial ended with ") + to_text(run.status) + ": " + run.reason);
    trial.error = 0.0;
    for (const Figure& f : left_out.estimates())
      if (f.relative() >= *trial.error) trial.error = f.relative(), trial.channel = f.name;
    const bool pieces = std::any_of(system.scalars().begin(), system.scalars().end(),
                                    [](const auto& s) { return linear_pieces(s).size() != 1; });
    double growth = 1.0;
    if (pieces && !(method.exact() && run.contact_changes == 0)) {
      const ErrorGrowth grown = measure_error_growth(
          reduced, {.method = method, .t_end = o.duration, .pieces = kGrowthPieces, .progress = o.progress});
      if (grown.status != RunStatus::success) return refuse("its trial: " + grown.reason);
      growth = grown.factor(o.duration);
      *trial.error *= growth;
    }
    std::ostringstream text;
    text.precision(2);
    text << "an error of " << percent_text(*trial.error) << " in " << trial.channel
         << " is estimated from a trial run";
    if (growth > 1.0) text << ", in which a small difference grows " << growth << " times";
    if (!(*trial.error <= o.within)) return refuse(text.str());
    trial.reason = choice.reason + "; " + text.str();
  } catch (const SolverError& error) {
    return refuse(error.what());
  }
  trial.method = method;
  trial.reduction = std::move(choice.reduction);
  return trial;
}

}  // namespace

ReductionTrial try_reduction(const System& system, const TrialOptions& o) {
  ReductionTrial first = try_choice(system, o, o.within);
  if (first.reduction || !first.error) return first;
  const double stricter = 0.5 * o.within * o.within / *first.error;
  if (!(stricter >= kReductionErrors.low)) return first;
  ReductionTrial second = try_choice(system, o, stricter);
  return second.reduction ? second : first;
}

}  // namespace drev
