#include <drev/advice/advise.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <utility>

#include "advice/evidence.hpp"
#include "advice/recipe.hpp"
#include "advice/simplify.hpp"
#include "core/names/rounded_text.hpp"
#include "models/figure_span.hpp"

namespace drev {

namespace {

constexpr double kAccuracy = 0.05;       // error of a figure itself over the one allowed
constexpr double kEnoughSeconds = 0.01;  // s of processor time are enough to measure
constexpr int kRepeats = 3;
constexpr double kMostCost = 3.0;     // cost of a rung over the full model's beyond which it is given up
constexpr double kExpensive = 0.5;    // cost of few modes over that of all, with their static shapes
constexpr double kStaticPart = 0.25;  // error of the loads' static shapes over the one allowed
constexpr double kAsCheap = 1.25;     // cost over the least one that counts as equal
constexpr int kSteadyTurns = 2;
constexpr double kSteadyPart = 0.2;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Time of the turn after which the loads repeat themselves; 0: not known.
double turn_time(const ModelCase& model_case, const System& system) {
  return time_of_turn(system, model_case.static_turn, model_case.duration);
}

class Ladder {
 public:
  Ladder(const ModelCase& model_case, const AdviseOptions& options)
      : Ladder(model_case, options, model_case.model.build()) {}

  Advice run() {
    advice_ = {.figure = options_.figure,
               .unit = find_channels(full_, figure_.channels).front().unit(),
               .within = options_.within};
    note_start();
    const std::vector<Level> levels = find_levels();
    measure_full(levels.front());
    std::vector<std::vector<Rung>> tried;
    std::vector<bool> stands;  // by level: it can be left out of
    for (const Level& level : levels) {
      const bool supported = level.from.empty() || std::any_of(level.from.begin(), level.from.end(),
                                                               [&](std::size_t i) { return stands[i]; });
      tried.push_back(climb(level, supported));
      const Rung& whole = tried.back().back();
      stands.push_back(whole.holds || (!whole.unsuitable.empty() && supported));
    }
    for (auto level = tried.rbegin(); level != tried.rend(); ++level)
      for (Rung& rung : *level) advice_.rungs.push_back(std::move(rung));
    choose();
    return std::move(advice_);
  }

 private:
  /// A model with something of the drive left out.
  struct Level {
    std::string name, leaves_out;
    Model model;
    bool gap = false, variation = false;  // left out
    std::vector<std::size_t> from = {};   // levels that leave out less
  };

  /// From the full model down.
  std::vector<Level> find_levels() const {
    std::vector<Level> levels{{"full model", "", model_case_.model}};
    std::vector<std::size_t> last{0};
    const auto add = [&](Level level) {
      level.from = last;
      levels.push_back(std::move(level));
      last = {levels.size() - 1};
    };
    const Flanks& flanks = evidence_.flanks();
    const auto mean = with_mean_stiffness(model_case_.model);
    const auto closed = without_backlash(model_case_.model, flanks);
    if (mean)
      add({closed ? "backlash, mean mesh stiffness" : "elastic meshes, mean stiffness",
           "variation of the mesh stiffness", *mean, false, true});
    if (closed) {
      last = {0};
      add({mean ? "no backlash, varying mesh stiffness" : "no backlash", "backlash", *closed, true, false});
    }
    if (closed && mean) {
      last = {1, 2};
      add({"no backlash, mean mesh stiffness", "backlash and variation of the mesh stiffness",
           *without_backlash(*mean, flanks), true, true});
    }
    if (const auto rigid = with_rigid_meshes(model_case_.model))
      add({"rigid meshes", "compliance and backlash of the meshes", *rigid, true, true});
    if (const auto held = with_drive_held(model_case_.model, nodes_of(model_case_.model, figure_.channels)))
      add({"gear held", "the gear drive", *held, true, true});
    return levels;
  }

  /// The level as it is, then its discretisations; cheap ones first. supported: a level that leaves out less
  /// holds; without one, this one could hold by chance only.
  std::vector<Rung> climb(const Level& level, bool supported) {
    const bool full = level.from.empty();
    Rung whole = full ? full_rung_
                      : measure({level.name, level.leaves_out}, {.model = level.model, .figure = figure_});
    if (!full && whole.unsuitable.empty())
      whole.evidence = evidence_.of_level(level.gap, level.variation, full_estimate_.watched);
    if (whole.holds && !supported) {
      whole.holds = false;
      whole.evidence = "within the limit by chance: a model that leaves out less is not";
    }
    std::vector<Rung> rungs;
    if (whole.holds) {
      const std::string in = full ? "" : level.name + ", ", and_out = full ? "" : level.leaves_out + "; ";
      if (figure_.from > 0.0) steady(level.model, in, and_out, rungs);
      modes(level.model, in, and_out, whole.cost, rungs);
      shafts(level.model, in, and_out, rungs);
    }
    rungs.push_back(std::move(whole));
    return rungs;
  }

  /// The periodic steady state of the level.
  void steady(const Model& model, const std::string& in, const std::string& and_out,
              std::vector<Rung>& rungs) {
    const double turns = model_case_.static_turn > 0.0 ? model_case_.static_turn / kTwoPi : 1.0;
    rungs.push_back(measure({in + "periodic steady state", and_out + "the transient"},
                            {.model = model, .figure = figure_, .turns = turns}));
  }

  /// Ever finer shafts until two in a row hold.
  void shafts(const Model& model, const std::string& in, const std::string& and_out,
              std::vector<Rung>& rungs) {
    const int finest = finest_shaft(model);
    if (finest == 0) return;
    const std::size_t first = rungs.size();
    const auto lumped = with_lumped_shafts(model);
    rungs.push_back(
        measure({in + "lumped shafts", and_out + "distribution of the shafts' inertia"}, recipe_of(*lumped)));
    for (int n = 1; n < finest && !confirmed(rungs, first); n *= 2) {
      const auto coarser = with_coarser_shafts(model, n);
      rungs.push_back(measure({in + "shafts of " + std::to_string(n) + (n == 1 ? " segment" : " segments"),
                               and_out + "finer segments of the shafts"},
                              recipe_of(*coarser)));
    }
    settle(rungs, first);
  }

  /// Ever more modes until two in a row hold; where the static shapes of many loads are expensive, without
  /// them.
  void modes(const Model& model, const std::string& in, const std::string& and_out, double cost,
             std::vector<Rung>& rungs) {
    const int unknowns = model.build().size();
    for (const bool shapes : {true, false}) {
      const std::size_t first = rungs.size();
      for (int n = 1; n <= unknowns / 2 && !confirmed(rungs, first); n *= 2) {
        const std::string name = std::to_string(n) + (n == 1 ? " mode" : " modes");
        rungs.push_back(
            measure({in + name + (shapes ? "" : " alone"),
                     and_out + (shapes ? "the inertia of the modes above" : "the modes above")},
                    {.model = model,
                     .figure = figure_,
                     .reduction = ReductionOptions{.modes = n,
                                                   .static_correction = shapes,
                                                   .static_accuracy = kStaticPart * options_.within}}));
        if (!rungs.back().unsuitable.empty()) break;
      }
      settle(rungs, first);
      if (rungs.size() == first || (rungs.back().holds && rungs[first].cost < kExpensive * cost)) return;
    }
  }

  static bool confirmed(const std::vector<Rung>& rungs, std::size_t first) {
    return rungs.size() >= first + 2 && rungs.back().holds && rungs[rungs.size() - 2].holds;
  }

  /// One that holds although the next finer one does not holds by chance. The level as it is, which holds,
  /// is finer than the last.
  static void settle(std::vector<Rung>& rungs, std::size_t first) {
    bool finer = true;
    for (std::size_t i = rungs.size(); i-- > first;) {
      const bool holds = rungs[i].holds;
      if (holds && !finer) {
        rungs[i].holds = false;
        rungs[i].evidence = "within the limit by chance: the next finer one is not";
      } else if (i + 1 < rungs.size() && rungs[i].unsuitable.empty()) {
        rungs[i].evidence =
            "the next finer one differs from it by " + percent(rungs[i + 1].difference - rungs[i].difference);
      }
      finer = holds;
    }
  }

  /// A figure of the steady state that still holds a part of the start.
  void note_start() {
    if (figure_.from == 0.0 || model_case_.start == Start::periodic) return;
    const Settling settling = settling_time(full_);
    if (settling.time <= figure_.from) return;
    advice_.notes.push_back(
        std::string(std::isfinite(settling.time) ? "The full model's run has not settled"
                                                 : "The full model's run is not known to settle") +
        " at " + rounded_text(figure_.from, 6) + " s, from where the figure counts: " + settling.reason +
        ". The figure holds what is left of the start, and a periodic steady state that differs from it may "
        "be the "
        "right one. A longer run, or one that starts there ([run] start = \"periodic\"), gives the steady "
        "figure.");
  }

  void measure_full(const Level& level) {
    full_rung_ = {
        .name = level.name, .leaves_out = "", .recipe = std::make_shared<Recipe>(level.model, figure_)};
    full_estimate_ = full_rung_.recipe->estimate();
    if (!full_estimate_.failure.empty()) throw SolverError(full_estimate_.failure);
    take(full_estimate_, full_rung_);
    full_rung_.holds = true;
    full_rung_.cost = 1.0;
    full_rung_.difference_error = full_rung_.error / scale();
    full_rung_.evidence = evidence_.of_full(full_estimate_.watched);
    advice_.statistic = full_estimate_.kind == Estimate::Kind::interval;
  }

  /// Fills in value, error and cost.
  void take(const FigureEstimate& estimate, Rung& rung) const {
    rung.value = estimate.value, rung.error = estimate.error;
    rung.recipe->figure.watch.clear();
    rung.seconds = std::numeric_limits<double>::infinity();
    double spent = 0.0;
    for (int i = 0; i < kRepeats && spent < kEnoughSeconds; ++i) {
      const double begin = processor_seconds();
      rung.recipe->run();
      const double seconds = processor_seconds() - begin;
      rung.seconds = std::min(rung.seconds, seconds);
      spent += seconds;
    }
  }

  struct Name {
    std::string name, leaves_out;
  };

  Recipe recipe_of(const RenamedModel& renamed) const {
    Recipe recipe{.model = renamed.model, .figure = figure_};
    for (std::string& channel : recipe.figure.channels)
      if (const auto other = renamed.renamed.find(channel); other != renamed.renamed.end())
        channel = other->second;
    return recipe;
  }

  Rung measure(const Name& name, Recipe recipe) const {
    if (options_.pause) options_.pause();
    recipe.figure.watch.clear();
    recipe.figure.most_seconds = kMostCost * full_rung_.seconds;
    Rung rung{.name = name.name,
              .leaves_out = name.leaves_out,
              .recipe = std::make_shared<Recipe>(std::move(recipe))};
    try {
      const FigureEstimate estimate = rung.recipe->estimate();
      rung.unsuitable = estimate.failure;
      if (!rung.unsuitable.empty()) return rung;
      take(estimate, rung);
    } catch (const ModelError& error) {
      rung.unsuitable = error.findings().front().text();
      return rung;
    } catch (const SolverError& error) {
      rung.unsuitable = error.what();
      return rung;
    }
    const double truth = std::abs(full_rung_.value), off = std::abs(rung.value - full_rung_.value);
    const double errors = rung.error + full_rung_.error;
    rung.difference = (rung.value - full_rung_.value) / scale();
    rung.difference_error = errors / scale();
    rung.holds = off + errors <= options_.within * (truth - full_rung_.error);
    rung.cost = rung.seconds / full_rung_.seconds;
    return rung;
  }

  /// What differences are relative to; a figure may be zero.
  double scale() const { return full_rung_.value != 0.0 ? std::abs(full_rung_.value) : 1.0; }

  /// Of those that cost about as little as the cheapest, the one that leaves out least, which stands last: times
  /// vary from run to run, and the choice should not.
  void choose() {
    double least = full_rung_.seconds;
    for (const Rung& rung : advice_.rungs)
      if (rung.holds) least = std::min(least, rung.seconds);
    advice_.chosen = advice_.rungs.size() - 1;
    while (!advice_.best().holds || advice_.best().seconds > kAsCheap * least) --advice_.chosen;
    advice_.sentence = evidence_.sentence(advice_);
  }

  Ladder(const ModelCase& model_case, const AdviseOptions& options, System built)
      : model_case_(model_case),
        options_(options),
        figure_(figure_options(model_case, built, options)),
        full_(started(std::move(built), figure_)),
        evidence_(full_) {
    const FigureSpan span = figure_span(model_case.settle, full_, model_case.start == Start::periodic,
                                        model_case.duration, model_case.static_turn);
    figure_.from = std::max(figure_.from, span.from);
    figure_.watch = evidence_.channels();
  }

  const ModelCase& model_case_;
  const AdviseOptions& options_;
  FigureOptions figure_;
  System full_;  // in its start
  Evidence evidence_;
  Advice advice_;
  Rung full_rung_{.name = {}, .leaves_out = {}, .recipe = nullptr};
  FigureEstimate full_estimate_;
};

}  // namespace

FigureOptions figure_options(const ModelCase& model_case, const System& system,
                             const AdviseOptions& options) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/advise", findings);
  check.within("within", options.within, options.kWithin.low, options.kWithin.high, "");
  FigureOptions figure{.t_end = model_case.duration,
                       .step = std::min(model_case.default_step, model_case.duration),
                       .start = model_case.start,
                       .accuracy = kAccuracy * options.within,
                       .pause = options.pause};
  std::string text = options.figure;
  if (text.starts_with("steady ")) {
    text = text.substr(7);
    const double turns = kSteadyTurns * turn_time(model_case, system);
    const double last = turns > 0.0 ? turns : kSteadyPart * model_case.duration;
    figure.from = model_case.duration - std::min(last, 0.5 * model_case.duration);
  }
  const std::string channel = text.starts_with("peak ") ? text.substr(5) : text;
  if (text == "peak deflection" && !model_case.deflection.empty())
    figure.channels = {model_case.deflection};
  else if (text == "peak torque" && !model_case.torques.empty())
    figure.channels = model_case.torques;
  else if (channel.find('.') != std::string::npos)
    figure.channels = {channel};
  else
    check.fail(
        "figure", options.figure, "",
        std::string(text == "peak deflection" ? "the model states no deflection ([run] deflection)"
                    : text == "peak torque"   ? "the model has no torques among which it is sought"
                                              : "is no figure") +
            "; it may be 'peak deflection' or 'peak torque' where the model has one, or 'peak CHANNEL', "
            "each also with 'steady ' before it");
  if (!findings.empty()) throw ModelError(findings);
  find_channels(system, figure.channels);
  return figure;
}

Advice advise(const ModelCase& model_case, const AdviseOptions& options) {
  return Ladder(model_case, options).run();
}

}  // namespace drev
