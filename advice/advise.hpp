#pragma once
/// How much of a model a figure needs: a ladder of simpler models, each measured against the full one.
///
///   levels      gear held; rigid meshes; elastic meshes; with backlash; with varying stiffness
///   of each     its lowest modes with the static shapes of the others; lumped shafts, or fewer segments of
///               distributed ones; for figures of the steady state the periodic response in place of a run
///
/// Promise of a rung that holds:  |figure - figure of the full model| <= within |figure of the full model|,
/// with the errors of both figures counted against it. Of a model case whose runs depend on the last digit of
/// their start the errors are the intervals that hold a single run in 95 % of all cases.
///
/// The full model is run: advice pays where many runs follow. So that none holds by chance, a level holds
/// only if one that leaves out less does, and a discretisation only if the next finer one does. What holds
/// does so for this model case and this figure (docs/fidelity.md). Every model is run from the model case's start, and
/// its figure counts from when the case has settled.
#include <drev/core/range.hpp>
#include <drev/models/model_case.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace drev {

class System;
struct FigureOptions;
struct Recipe;

struct AdviseOptions {
  /// "peak deflection", "peak torque" (the model case's), "peak CHANNEL"; "steady peak ..." counts the last
  /// turns only: two of the model case's static_turn, or the last fifth of the run.
  std::string figure = "peak deflection";
  double within = 0.02;  ///< relative
  static constexpr Range kWithin{1e-4, 0.5};
  std::function<void()> pause = {};  ///< called now and then; what it throws ends the advice
};

struct Rung {
  std::string name;
  std::string leaves_out;                           ///< empty: the full model
  std::string unsuitable = {};                      ///< why it has no value; empty: it has
  double value = 0.0, error = 0.0;                  ///< of the figure
  double difference = 0.0, difference_error = 0.0;  ///< over the full model's figure
  double seconds = 0.0;                             ///< processor time to build it and run it once
  double cost = 0.0;                                ///< seconds over the full model's
  bool holds = false;
  std::string evidence = {};
  std::shared_ptr<Recipe> recipe;  ///< the model to be run for the figure, and how (recipe.hpp)
};

struct Advice {
  std::string figure = {}, unit = {};
  double within = 0.0;
  bool statistic = false;        ///< the full model's figure has an interval instead of an error
  std::vector<Rung> rungs = {};  ///< every one tried, cheap levels first; the full model is the last
  std::size_t chosen = 0;        ///< the cheapest that holds
  std::string sentence = {};
  /// Sentences on the full model's figure: of a steady one, that its run has not settled where it begins.
  std::vector<std::string> notes = {};
  const Rung& best() const { return rungs[chosen]; }
  const Rung& full() const { return rungs.back(); }
};

/// What the figure counts, in the names of the model case's model; advise() alone leaves out what settles. Throws
/// ModelError for one that cannot be.
FigureOptions figure_options(const ModelCase& model_case, const System& system, const AdviseOptions& options);

/// Throws ModelError for a figure or limit that cannot be, SolverError where the full model cannot be run or has no
/// start.
Advice advise(const ModelCase& model_case, const AdviseOptions& options);

}  // namespace drev
