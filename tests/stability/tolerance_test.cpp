// The tolerance asked for against the true error, on random linear, contact and varying-stiffness models.
//
// The tolerance bounds what a method adds; the motion itself may amplify it. How much is measured: the
// largest growth of deviations from the start and from half the time on. The error judged is that at the
// end over max(growth, 1), relative to the largest deviation and rate of the run.
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <array>
#include <cmath>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/stability/random_model.hpp"
#include "tests/stability/runge_kutta.hpp"

using namespace drev;

namespace {

constexpr double kAllowed = 3.0;  // of the tolerance
constexpr double kMoved = 1e-9;   // start of the deviations whose growth is measured
constexpr unsigned kModels = 24;  // of each kind

struct Kind {
  const char* name;
  unsigned first_seed;
  ModelRanges ranges;
};
const Kind kKinds[] = {
    {"linear", 3000, {.masses = 6, .gaps = 0, .decades = 3.0, .duration = 40.0}},
    {"contact", 4000, {.masses = 6, .gaps = 4, .decades = 3.0, .duration = 40.0}},
    {"varying", 5000, {.masses = 4, .gaps = 2, .decades = 2.0, .varying = true, .duration = 25.0}}};

/// Largest deviation and rate of a run.
class Scales final : public Observer {
 public:
  void start(const Assembler&, const EvaluatedState& point) override { look_at(point.state); }
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override { look_at(to.state); }
  double difference(const State& a, const State& b) const {
    return std::max((a.z - b.z).lpNorm<Eigen::Infinity>() / z, (a.v - b.v).lpNorm<Eigen::Infinity>() / v);
  }
  double z = 1e-300, v = 1e-300;

 private:
  void look_at(const State& s) {
    z = std::max(z, s.z.lpNorm<Eigen::Infinity>());
    v = std::max(v, s.v.lpNorm<Eigen::Infinity>());
  }
};

/// A model with its true motion and what that does to deviations.
struct Judge {
  Judge(const RandomModel& m, unsigned seed) : model(m), truth(State::initial(m.system)) {
    const ExactOptions tight{.tolerance = 1e-13, .t_end = m.t_end};
    REQUIRE(propagate(m.system, tight, truth, {&scales}).ok());
    Random random(seed);
    State half = State::initial(m.system);
    ExactOptions to_half = tight, from_half = tight;
    to_half.t_end = from_half.t_start = 0.5 * m.t_end;
    REQUIRE(propagate(m.system, to_half, half).ok());
    for (int i = 0; i < 6; ++i) {
      State moved = i % 2 ? half : State::initial(m.system);
      for (double& z : moved.z) z += kMoved * scales.z * (random.below(2) ? 1 : -1);
      for (double& v : moved.v) v += kMoved * scales.v * (random.below(2) ? 1 : -1);
      REQUIRE(propagate(m.system, i % 2 ? from_half : tight, moved).ok());
      growth = std::max(growth, scales.difference(moved, truth) / kMoved);
    }
  }
  double error(const State& state) const { return scales.difference(state, truth) / growth; }

  const RandomModel& model;
  State truth;
  Scales scales;
  double growth = 1.0;
};

}  // namespace

TEST_CASE("The true error stays below 3 times the tolerance on 72 random models") {
  struct Method {
    const char* name;
    double least;  // tolerance
  };
  const Method methods[] = {{"exact", 1e-9},
                            {"dormand_prince", 1e-9},
                            {"sdirk4", 1e-9},
                            {"average_acceleration", 1e-5},
                            {"generalized_alpha:0.8", 1e-5}};
  for (const Kind& kind : kKinds) {
    constexpr std::array<double, 5> kTolerances{1e-2, 1e-3, 1e-5, 1e-7, 1e-9};
    double worst[5][kTolerances.size()] = {};
    for (unsigned i = 0; i < kModels; ++i) {
      const unsigned seed = kind.first_seed + i;
      const RandomModel model = random_model(seed, kind.ranges);
      const Judge judge(model, seed);
      for (int m = 0; m < 5; ++m)
        for (std::size_t k = 0; k < kTolerances.size(); ++k) {
          const double tolerance = kTolerances[k];
          if (tolerance < methods[m].least) continue;
          State state = State::initial(model.system);
          const RunSummary run = m == 0 ? propagate(model.system,
                                                    {.tolerance = tolerance,
                                                     .t_end = model.t_end,
                                                     .energy_tolerance = std::max(1e-6, 100 * tolerance)},
                                                    state)
                                        : simulate(model.system,
                                                   {.scheme = step_scheme(methods[m].name),
                                                    .tolerance = tolerance,
                                                    .t_end = model.t_end},
                                                   state);
          const double ratio = judge.error(state) / tolerance;
          INFO(kind.name << " " << seed << ", " << methods[m].name << " " << tolerance << ": " << ratio
                         << " of it, deviations grow by " << judge.growth << "; " << run.brief_report());
          CHECK(run.ok());
          CHECK(ratio < kAllowed);
          worst[m][k] = std::max(worst[m][k], ratio);
        }
    }
    std::ostringstream table;
    for (int m = 0; m < 5; ++m) {
      table << "\n  " << methods[m].name;
      for (const double ratio : worst[m]) table << ' ' << ratio;
    }
    INFO("worst of the " << kind.name << " models, over the tolerance:" << table.str());
    // Most of the tolerance is used by some model: the bound is no empty one.
    CHECK(worst[0][1] > 0.03);
  }
}

TEST_CASE("The truth of the tolerance test is that of Runge-Kutta in small steps") {
  for (const Kind& kind : kKinds)
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned seed = kind.first_seed + i;
      INFO(kind.name << " " << seed);
      const RandomModel model = random_model(seed, kind.ranges);
      const Judge judge(model, seed);
      State state = State::initial(model.system);
      runge_kutta(model.system, model.t_end, 1e-3 / model.fastest, state);
      CHECK(judge.error(state) < 1e-5);  // of first order where a load or contact damper jumps
    }
}
