// What advice saves: processor time of the full model over that of the model advised for a figure to 2 %, on
// the forty models of the test and the camshaft. Both by the cheapest method that keeps a twentieth of that,
// from the description on.
//   build/release/bin/bench_advise
//   build/release/bin/bench_advise "[rungs]"    with every model tried
#include <drev/advice/advise.hpp>
#include <drev/models/ready_made.hpp>

#include <algorithm>
#include <cstdio>

#include "advice/recipe.hpp"
#include "tests/catch.hpp"
#include "tests/problems/advice_models.hpp"

using namespace drev;

namespace {

double times_cheaper(const ModelCase& model_case, const std::string& name, bool rungs) {
  const Advice a = advise(model_case, {.figure = "peak deflection", .within = 0.02});
  std::printf("%-46s %4d %9.2f ms  %6.1f times by %s, off by %.2g +- %.2g %%\n", name.c_str(),
              model_case.model.build().size(), 1e3 * a.full().seconds, 1.0 / a.best().cost,
              a.best().name.c_str(), 100 * a.best().difference, 100 * a.best().difference_error);
  for (const Rung& r : a.rungs)
    if (rungs)
      std::printf("    %-46s %+9.3f +- %.3f %%  cost %.3f%s  %s %s\n", r.name.c_str(), 100 * r.difference,
                  100 * r.difference_error, r.cost, r.holds ? ", holds" : "",
                  to_text(r.recipe->method).c_str(), r.unsuitable.c_str());
  std::fflush(stdout);
  return 1.0 / a.best().cost;
}

void measure(bool rungs) {
  std::vector<double> cheaper;
  std::printf("model, unknowns, processor time of the full model; model advised\n");
  for (int i = 0; i < test::kAdviceModels; ++i) {
    const ModelCase model_case = test::advice_model(i);
    cheaper.push_back(times_cheaper(model_case, model_case.model.name(), rungs));
  }
  std::sort(cheaper.begin(), cheaper.end());
  std::printf("median %.1f times, at least 5 times on %ld of %zu\n", cheaper[cheaper.size() / 2],
              std::count_if(cheaper.begin(), cheaper.end(), [](double c) { return c >= 5.0; }),
              cheaper.size());
  for (const char* cylinders : {"6", "9"}) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("cylinders", cylinders);
    s.set("duration_s", "1");
    times_cheaper(build_camshaft(s), std::string("camshaft, cylinders ") + cylinders, rungs);
  }
}

}  // namespace

TEST_CASE("Processor time of advised models") { measure(false); }
TEST_CASE("Processor time of every model tried", "[.][rungs]") { measure(true); }
