// Advice on how much of a model a figure needs never promises more than holds: forty drivetrains and the
// camshaft with 6 to 10 cylinders at 750 rpm and at its worst speed. The full model is run by another method
// than the advice's, and the figure of the model advised is found again from its recipe.
#include <drev/advice/advise.hpp>
#include <drev/core/units.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>

#include "advice/figure_estimate.hpp"
#include "advice/recipe.hpp"
#include "tests/catch.hpp"
#include "tests/problems/advice_models.hpp"

using namespace drev;

namespace {

constexpr double kWithin = 0.02;

/// Explicit steps where the advice propagated exactly; a scheme of second order with a quarter of the step
/// where it took implicit ones.
Method another(const Method& method) {
  if (method.exact()) return {.name = "dormand_prince", .tolerance = 1e-6};
  return {.name = "bathe", .step = 0.25 * method.step};
}

void check_promise(const ModelCase& model_case, const Advice& a) {
  INFO(model_case.model.name() << ": " << a.sentence);
  for (const Rung& rung : a.rungs)
    UNSCOPED_INFO(rung.name << ": " << rung.value << " +- " << rung.error << (rung.holds ? " holds" : "")
                            << "; " << rung.unsuitable << rung.evidence);
  const Rung& full = a.full();
  const System system = model_case.model.build();
  const double truth = figure_of_run(system, another(full.recipe->method), full.recipe->figure);
  if (a.chosen + 1 == a.rungs.size() && a.statistic) {  // runs of the full model itself differ by more
    CHECK(std::abs(full.value - truth) <= 2.0 * full.error);
    return;
  }
  CHECK(std::abs(a.best().recipe->run() - truth) <= kWithin * std::abs(truth));
  // Nor does any other rung that is said to hold.
  for (const Rung& rung : a.rungs)
    if (rung.holds && !a.statistic) CHECK(std::abs(rung.value - truth) <= kWithin * std::abs(truth));
}

Parameters camshaft(int cylinders, double engine_rpm, const char* drive) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("cylinders", std::to_string(cylinders));
  s.set("engine_rpm", to_text(engine_rpm));
  s.set("drive", drive);
  s.set("duration_s", "0.2");
  return s;
}

/// The speed, of those at which an order of the camshaft meets its first mode with the gear held, with the
/// largest steady twist.
double worst_speed(int cylinders) {
  const System held = build_camshaft(camshaft(cylinders, 750, "held")).model.build();
  const double f = solve_modes(held, {.count = 1}).frequency_Hz[0];
  double worst = 0.0, largest = 0.0;
  for (int order = 8; order <= 20; ++order) {
    const double speed = 2.0 * 60.0 * f / order;
    const ModelCase model_case = build_camshaft(camshaft(cylinders, speed, "held"));
    const PeriodicResponse r =
        solve_periodic(model_case.model.build(), {.tolerance = 0.02, .channels = {model_case.deflection}});
    if (r.found && r.peaks[0].amplitude() > largest) largest = r.peaks[0].amplitude(), worst = speed;
  }
  return worst;
}

void check_models(int begin, int end, int stride) {
  int simpler = 0, models = 0;
  for (int i = begin; i < end; i += stride) {
    const ModelCase model_case = test::advice_model(i);
    // One in four for the torques.
    const Advice a =
        advise(model_case, {.figure = i % 4 == 3 ? "peak torque" : "peak deflection", .within = kWithin});
    check_promise(model_case, a);
    // Which simpler models are no slower than the full one depends on the machine and on what else it does.
    if (std::any_of(a.rungs.begin(), a.rungs.end(),
                    [](const Rung& r) { return r.unsuitable.find("takes longer") != std::string::npos; }))
      continue;
    ++models;
    simpler += a.chosen + 1 < a.rungs.size();
  }
  CHECK(simpler >= models / 2);  // the full model each time would be right too
}

void check_camshaft(int cylinders) {
  for (const double speed : {750.0, worst_speed(cylinders)}) {
    REQUIRE(speed > 0.0);
    INFO(cylinders << " cylinders at " << speed << " rpm");
    const ModelCase model_case = build_camshaft(camshaft(cylinders, speed, "gears"));
    check_promise(model_case, advise(model_case, {.within = kWithin}));
  }
}

}  // namespace

TEST_CASE("Advice keeps its promise on distributed shafts and chains") {
  check_models(0, test::kAdviceModels / 2, 3);
}

TEST_CASE("Advice keeps its promise with varying stiffness, two meshes, cams") {
  check_models(test::kAdviceModels / 2, test::kAdviceModels, 3);
}

TEST_CASE("Advice keeps its promise on the camshaft with 9 cylinders") { check_camshaft(9); }

TEST_CASE("Advice keeps its promise on forty drivetrains and the camshaft with 6 to 10 cylinders",
          "[.long]") {
  check_models(0, test::kAdviceModels, 1);
  for (int cylinders = 6; cylinders <= 10; ++cylinders) check_camshaft(cylinders);
}

TEST_CASE("Advice on a steady figure: the periodic response in place of a run") {
  const ModelCase model_case = build_camshaft(camshaft(6, 750, "held"));
  const Advice a = advise(model_case, {.figure = "steady peak deflection", .within = kWithin});
  check_promise(model_case, a);
}
