// Verdicts of random drivetrains (random_spec.hpp) under every damping law, with tables that jump and speeds that
// change at once: no run that is right ends as energy_error, and none that is wrong as success without a warning. What is
// right says the suite's own reference, in extended precision.
#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/catch.hpp"
#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/random_spec.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace {

using namespace coverage;
using drev::Method;

constexpr double kWrong = 0.25;      // of the largest angle, or speed
constexpr double kRight = 1e-3;      // the same, of methods with steps
constexpr double kComparable = 1e3;  // growth of a small difference up to which peaks are compared

/// Largest angles and speeds of the nodes.
struct Truth {
  std::vector<std::string> names;
  std::vector<bool> speed;
  std::vector<double> peak;
  double scale[2] = {0.0, 0.0};
  explicit Truth(const Case& c) {
    const ReferenceModel model(c.spec);
    for (std::size_t i = 0; i < model.channels().size(); ++i) {
      const ChannelId& id = model.channels()[i];
      if (id.kind != ChannelId::Kind::angle && id.kind != ChannelId::Kind::speed) continue;
      names.push_back(id.name);
      speed.push_back(id.kind == ChannelId::Kind::speed);
      peak.push_back(static_cast<double>(c.fine.peaks[i].amplitude()));
      scale[speed.back()] = std::max(scale[speed.back()], peak.back());
    }
  }
};

struct Judged {
  drev::RunSummary run;
  double off = 0.0;  ///< largest error of a peak, relative to the largest of its kind
};

Judged judge(const drev::System& system, const Truth& truth, const Method& method, double duration) {
  Judged j;
  drev::Peaks peaks(drev::find_channels(system, truth.names));
  try {
    j.run = drev::run_method(system, method, {.t_end = duration}, {&peaks});
  } catch (const drev::SolverError& error) {
    j.run.status = drev::RunStatus::no_convergence;
    j.run.reason = error.what();
  }
  for (std::size_t i = 0; i < truth.names.size(); ++i)
    j.off =
        std::max(j.off, std::abs(peaks.peaks()[i].amplitude() - truth.peak[i]) / truth.scale[truth.speed[i]]);
  return j;
}

/// What the tests have seen: tests of which one side is empty would say nothing.
struct Count {
  int right = 0, wrong = 0, said = 0;
};

void check(const Case& c, const drev::System& system, const Method& method, Count& count) {
  const Judged j = judge(system, Truth(c), method, c.spec.duration);
  const double right = method.exact() ? 10.0 * method.tolerance * c.growth : kRight;
  INFO(c.spec.name << " (" << c.spec.family << "), growth " << c.growth << ", off by " << j.off << ": "
                   << j.run.brief_report());
  if (j.off <= right) {
    ++count.right;
    CHECK(j.run.ok());
  } else if (j.off > kWrong) {
    ++count.wrong;
    CHECK((!j.run.ok() || !j.run.warnings.empty()));
  } else {
    count.said += j.run.ok() ? 0 : 1;
  }
}

/// The cases of these seeds whose reference is comparable.
void over(unsigned first, unsigned last, const std::function<bool(Spec&, unsigned)>& change,
          const std::function<void(const Case&)>& body) {
  for (unsigned seed = first; seed <= last; ++seed) {
    Spec spec = random_spec(seed);
    if (!change(spec, seed)) continue;
    const Case c = make_case(spec);
    if (c.usable && c.growth < kComparable) body(c);
  }
}

/// The damping laws in turn.
void turn_laws(Spec& spec, unsigned seed) {
  for (std::size_t i = 0; i < spec.meshes.size(); ++i) spec.meshes[i].law = static_cast<Law>((seed + i) % 4);
}

/// Steps from far too long to short, in parts of the fastest mode's period over 2 pi.
std::vector<Method> with_steps(const drev::System& system, double duration,
                               const std::vector<double>& parts) {
  std::vector<Method> all;
  for (const char* name : {"average_acceleration", "hht:0.1", "bathe", "sdirk4", "generalized_alpha:0.8"})
    for (const double part : parts)
      if (const double step = part / drev::fastest_rate(system); step < duration / 3)
        all.push_back({.name = name, .step = step});
  return all;
}

}  // namespace

TEST_CASE("Verdicts: random drivetrains under every damping law, right runs and wrong ones", "[verdict]") {
  Count count;
  over(
      1, 20,
      [](Spec& spec, unsigned seed) {
        turn_laws(spec, seed);
        return true;
      },
      [&](const Case& c) {
        const drev::System system = to_drev(c.spec);
        for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10})
          check(c, system, {.name = "exact", .tolerance = tolerance}, count);
        for (const char* name : {"dormand_prince", "average_acceleration"})
          check(c, system, {.name = name, .tolerance = 1e-5}, count);
        for (const Method& method : with_steps(system, c.spec.duration, {0.1, 2.0, 8.0, 32.0}))
          check(c, system, method, count);
      });
  CHECK(count.right > 60);
  CHECK(count.wrong > 40);
}

TEST_CASE("Verdicts: a nominal speed that changes within microseconds", "[verdict]") {
  Count count;
  over(
      1, 40,
      [](Spec& spec, unsigned seed) {
        turn_laws(spec, seed);
        Nominal& n = spec.nominal;
        if (n.node < 0) return false;
        n.omega_1 = n.omega_0 * (seed % 3 ? 1.01 : 0.97);
        n.t_0 = 0.3 * spec.duration;
        n.t_1 = n.t_0 + (seed % 5 ? 1e-4 : 1e-5);
        return true;
      },
      [&](const Case& c) {
        const drev::System system = to_drev(c.spec);
        for (const double tolerance : {1e-4, 1e-8})
          check(c, system, {.name = "exact", .tolerance = tolerance}, count);
        check(c, system, {.name = "dormand_prince", .tolerance = 1e-5}, count);
        for (const Method& method : with_steps(system, c.spec.duration, {2.0, 8.0, 32.0}))
          check(c, system, method, count);
      });
  CHECK(count.right > 20);
  CHECK(count.wrong > 20);
}

TEST_CASE("Verdicts: a shaft a million times as stiff, with the step unchanged", "[verdict]") {
  Count count;
  over(
      1, 60,
      [](Spec& spec, unsigned) {
        // In the reference the shaft is rigid: what is behind it turns with it.
        if (spec.shafts.empty() || spec.nodes.size() < 3) return false;
        const Shaft rigid = spec.shafts.front();
        for (const Gear& g : spec.gears)
          if (g.b == rigid.b) return false;
        for (const int node : {rigid.a, rigid.b})
          if (spec.nodes[static_cast<std::size_t>(node)].angle != 0.0 ||
              spec.nodes[static_cast<std::size_t>(node)].speed != 0.0)
            return false;
        spec.rayleigh_stiffness = 0.0;
        spec.shafts.erase(spec.shafts.begin());
        spec.gears.push_back({rigid.a, rigid.b, 1.0});
        return true;
      },
      [&](const Case& c) {
        const drev::System rigid = to_drev(c.spec);
        Spec stiff = c.spec;
        const Gear joint = stiff.gears.back();
        stiff.gears.pop_back();
        const double soft =
            random_spec(static_cast<unsigned>(std::stoul(c.spec.name.substr(7)))).shafts.front().stiffness;
        stiff.shafts.push_back({joint.a, joint.b, 1e6 * soft, 0.0});
        const drev::System system = to_drev(stiff);
        for (const Method& method : with_steps(rigid, c.spec.duration, {0.1, 1.0, 4.0, 16.0}))
          check(c, system, method, count);
      });
  CHECK(count.right > 10);
  CHECK(count.wrong > 10);
}
