// Random drawings of gear pairs: each gives a mesh cycle with errors or is refused with the dimension named, and none
// takes longer than it may.
//   build/release/bin/fuzz_gears [COUNT] [SEED]     default 40 drawings; prints what became of them
#include <drev/core/error.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

namespace {

using namespace drev;
constexpr double kLongest = 20.0;  // s a drawing, on a machine under load and with sanitizers

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double part) { return between(0.0, 1.0) < part; }
  /// Now and then something that no drawing has.
  double spoiled(double value) {
    if (!chance(0.004)) return value;
    const double odd[] = {0.0, -value, 1e300, 1e-300, std::nan(""), INFINITY};
    return odd[whole(0, 5)];
  }

 private:
  std::mt19937 engine_;
};

GearDrawing random_drawing(Random& r) {
  GearDrawing d;
  GearGeometry& g = d.geometry;
  g.module = r.spoiled(std::pow(10.0, r.between(-3.3, -1.5)));
  g.pressure_angle = r.spoiled(r.chance(0.6) ? 0.3490658503988659 : r.between(0.24, 0.45));
  g.helix_angle = r.chance(0.7) ? 0.0 : r.spoiled(r.between(0.0, 0.6));
  g.internal = r.chance(0.15);
  if (r.chance(0.2)) g.rack = {r.between(0.7, 1.3), r.between(1.0, 1.6), r.spoiled(r.between(0.0, 0.45))};
  for (GearData* gear : {&g.gear_1, &g.gear_2}) {
    gear->teeth = r.chance(0.01) ? r.whole(-3, 3000) : r.whole(10, 150);
    if (r.chance(0.9)) gear->profile_shift = r.spoiled(r.between(-0.4, 0.7));
    const double pitch = g.module * gear->teeth;
    if (r.chance(0.1)) gear->tip_diameter = r.spoiled(pitch + g.module * r.between(1.0, 3.0));
    if (r.chance(0.2)) gear->tip_alteration = r.between(-0.4, 0.1);
    if (r.chance(0.2)) gear->tip_chamfer = r.spoiled(g.module * r.between(0.0, 0.2));
    gear->width = r.spoiled(g.module * r.between(2.0, 25.0));
    const bool ring = g.internal && gear == &g.gear_2 && r.chance(0.97);
    if (ring) gear->teeth = g.gear_1.teeth + r.whole(3, 120);
    if (ring) gear->tip_alteration = r.between(-0.4, 0.0);
    if (ring) gear->outer_diameter = r.spoiled(g.module * (gear->teeth + 2.5 + r.between(0.2, 30.0)));
    if (!ring && r.chance(0.97)) gear->bore_diameter = r.spoiled(pitch * r.between(0.02, 0.98));
    if (!ring && r.chance(0.2)) {
      gear->hub_diameter = r.spoiled(gear->bore_diameter * r.between(1.0, 1.5));
      gear->rim_inner_diameter = r.spoiled(pitch * r.between(0.4, 0.95));
      gear->web_thickness = r.spoiled(gear->width * r.between(0.01, 1.1));
    }
    gear->material.youngs_modulus = r.spoiled(std::pow(10.0, r.between(9.0, 12.0)));
    gear->material.poisson_ratio = r.spoiled(r.between(0.0, 0.49));
  }
  if (r.chance(0.3))
    g.centre_distance =
        r.spoiled(0.5 * g.module * std::abs(g.gear_2.teeth + (g.internal ? -1 : 1) * g.gear_1.teeth) /
                      std::cos(g.helix_angle) +
                  g.module * r.between(-0.5, 1.0));
  for (TipRelief& relief : d.cycle.tip_relief)
    if (r.chance(0.2))
      relief = {r.spoiled(g.module * r.between(0.0, 0.02)), r.spoiled(g.module * r.between(0.1, 2.0))};
  for (ThicknessTolerance& t : d.tolerances.thickness)
    if (r.chance(0.5))
      t = {-r.spoiled(g.module * r.between(0.0, 0.05)), r.spoiled(g.module * r.between(0.0, 0.03))};
  d.cycle.load = r.spoiled(std::pow(10.0, r.between(2.0, 6.5)));
  d.cycle.points = r.whole(4, 24);
  d.cycle.corner_contact = r.chance(0.7);
  d.cycle.windup = r.chance(0.8);
  if (r.chance(0.1))
    for (int i = 0; i < 3; ++i) d.loads.push_back(r.spoiled(d.cycle.load * std::pow(3.0, i - 1)));
  return d;
}

/// What is wrong with a result; empty: nothing.
std::string fault_of(const GearDrawing& drawing, const GearMeshData& data) {
  const MeshFigures &f = data.cycle.figures(), &e = data.cycle.errors();
  for (const double value :
       {f.mean, f.tangent_mean, f.highest, f.lowest, f.error_mean, f.loaded_contact_ratio})
    if (!(value > 0.0) || !std::isfinite(value)) return "a figure is not positive";
  for (const double value : {e.mean, e.tangent_mean, e.error_mean, e.error_peak_to_peak})
    if (!(value >= 0.0) || !std::isfinite(value)) return "an error is not a number";
  if (data.load_law && !(data.load_law->error.most >= 0.0)) return "a law over the load without an error";
  if (!(e.mean < f.mean)) return "an error as large as the figure";
  for (const MeshPoint& p : data.cycle.points())
    if (!(p.tangent >= 0.95 * p.secant) && drawing.cycle.tip_relief[0].depth == 0.0 &&
        drawing.cycle.tip_relief[1].depth == 0.0)
      return "a tangent below its secant";
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 40;
  const auto seed = static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1);
  Random random(seed);
  std::map<std::string, int> refused;
  int computed = 0, faults = 0;
  double slowest = 0.0, total = 0.0, worst = 0.0;
  for (int i = 0; i < count; ++i) {
    const GearDrawing drawing = random_drawing(random);
    const auto begin = std::chrono::steady_clock::now();
    std::string fault;
    try {
      const GearMeshData data = gear_mesh_data(drawing);
      ++computed;
      worst = std::max(worst, data.cycle.errors().mean / data.cycle.figures().mean);
      fault = fault_of(drawing, data);
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings())
        if (finding.parameter.empty() || finding.range.empty()) fault = "a refusal without its dimension";
      ++refused[error.findings().front().parameter];
    } catch (const std::exception& error) {
      fault = error.what();
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    slowest = std::max(slowest, seconds);
    total += seconds;
    if (seconds > kLongest) fault = "took " + to_text(seconds) + " s";
    if (!fault.empty() && ++faults <= 20) std::printf("drawing %d of seed %u: %s\n", i, seed, fault.c_str());
  }
  std::printf(
      "%d drawings: %d computed, %d refused, %d faults; largest error stated %.2g; slowest %.3f s, mean %.4f "
      "s\n",
      count, computed, count - computed - faults, faults, worst, slowest, total / std::max(count, 1));
  for (const auto& [name, times] : refused) std::printf("  refused by %s: %d\n", name.c_str(), times);
  return faults == 0 ? 0 : 1;
}
