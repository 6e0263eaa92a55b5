#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/gears/gear_drawing.hpp>
#include <drev/models/ready_made.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "models/gears/gear_element.hpp"

namespace drev {

namespace {

constexpr double kCrankGearInertia = 6.0, kIdlerInertia = 14.0;  // kg m^2, typical
constexpr double kCamshaftGearInertia = 6.461;                   // kg m^2, fitted with the camshaft
constexpr int kCrankTeeth = 59, kBigIdlerTeeth = 68, kSmallIdlerTeeth = 34, kCamshaftTeeth = 59;
constexpr double kModule1 = mm(8), kModule2 = mm(9), kPressureAngle = deg(20);
// One and two pairs of teeth [N/m], along the line of action: torque over base radius over deflection.
// Table 4.2 of the source divides by the pitch radius and is lower by cos 20 deg.
constexpr double kSingle1 = 6.582e8, kDouble1 = 1.1021e9, kSingle2 = 7.698e8, kDouble2 = 8.563e8;
// The source's square wave has equal parts of one and two pairs; its series has ten harmonics; the second
// mesh is pi/4, an eighth of a period, behind the first.
constexpr double kContactRatio = 1.5, kSecondMeshPhase = 0.125;
constexpr int kMeshHarmonics = 10;

struct DriveMesh {
  double module, shift, tips, distance, width, load;
  int teeth_1, teeth_2;
};
constexpr DriveMesh kMesh1{kModule1, -0.626, -0.27, mm(497), mm(88), 44.5e3, kCrankTeeth, kBigIdlerTeeth};
constexpr DriveMesh kMesh2{kModule2, -0.082, 0.0, mm(417), mm(130), 30.8e3, kSmallIdlerTeeth, kCamshaftTeeth};

/// k of mesh 1 or 2 by its drawing; computed once.
const MeshStiffness& drawn_stiffness(int mesh) {
  static const MeshStiffness first = gear_mesh_params(gear_drive_drawing(1)).stiffness;
  static const MeshStiffness second = gear_mesh_params(gear_drive_drawing(2)).stiffness;
  return mesh == 1 ? first : second;
}

MeshStiffness times(const MeshStiffness& stiffness, double factor) {
  const auto& table = std::get<PeriodicTable>(stiffness.law());
  std::vector<double> values = table.values();
  for (double& k : values) k *= factor;
  return MeshStiffness::table(table.arguments(), std::move(values));
}

MeshStiffness stiffness(int mesh, double single, double both, double factor, MeshVariation variation) {
  if (variation == MeshVariation::drawing) return times(drawn_stiffness(mesh), factor);
  if (variation == MeshVariation::drawing_mean) return factor * drawn_stiffness(mesh).mean();
  single *= factor, both *= factor;
  if (variation == MeshVariation::step) return MeshStiffness::step(single, both, kContactRatio);
  if (variation == MeshVariation::fourier)
    return MeshStiffness::fourier_of_step(single, both, kContactRatio, kMeshHarmonics);
  return 0.5 * (single + both);
}

}  // namespace

GearDrawing gear_drive_drawing(int mesh, double bore) {
  constexpr double kDedendum = 1.25;
  const DriveMesh& m = mesh == 1 ? kMesh1 : kMesh2;
  GearDrawing drawing;
  drawing.geometry.module = m.module;
  drawing.geometry.centre_distance = m.distance;
  drawing.cycle.load = m.load;
  GearData* gears[] = {&drawing.geometry.gear_1, &drawing.geometry.gear_2};
  for (const int i : {0, 1}) {
    GearData& g = *gears[i];
    g.teeth = i == 0 ? m.teeth_1 : m.teeth_2;
    g.profile_shift = m.shift;
    g.tip_alteration = m.tips;
    g.width = m.width;
    g.bore_diameter = bore * m.module * (g.teeth + 2.0 * m.shift - 2.0 * kDedendum);
    drawing.tolerances.thickness[static_cast<std::size_t>(i)].upper_allowance = -mm(0.09);  // or it jams
  }
  return drawing;
}

void add_gear_drive(Model& m, const std::string& camshaft_gear, const GearDriveParams& p) {
  m.add_node("crank_gear");
  m.add_node("idler");
  m.add<Inertia>("J_crank_gear", {"crank_gear"}, {.inertia = kCrankGearInertia});
  m.add<Inertia>("J_idler", {"idler"}, {.inertia = kIdlerInertia});
  m.add<GearMesh>("mesh_1", {"crank_gear", "idler"},
                  {.module = kModule1,
                   .teeth_1 = kCrankTeeth,
                   .teeth_2 = kBigIdlerTeeth,
                   .pressure_angle = kPressureAngle,
                   .stiffness = stiffness(1, kSingle1, kDouble1, p.stiffness_factor, p.variation),
                   .normal_backlash = p.normal_backlash,
                   .damping = p.mesh_damping});
  m.add<GearMesh>("mesh_2", {"idler", camshaft_gear},
                  {.module = kModule2,
                   .teeth_1 = kSmallIdlerTeeth,
                   .teeth_2 = kCamshaftTeeth,
                   .pressure_angle = kPressureAngle,
                   .stiffness = stiffness(2, kSingle2, kDouble2, p.stiffness_factor, p.variation),
                   .normal_backlash = p.normal_backlash,
                   .damping = p.mesh_damping,
                   .mesh_phase = kSecondMeshPhase});
}

std::vector<Parameter> gear_drive_parameters() {
  using Kind = Parameter::Kind;
  return {{"backlash_mm",
           Kind::number,
           "0.15",
           "mm",
           0,
           10,
           {},
           "total normal backlash of each mesh, along the line of action"},
          {"mesh_stiffness",
           Kind::choice,
           "mean",
           "",
           0,
           0,
           {"mean", "step", "fourier", "drawing", "drawing_mean"},
           "constant mean, square wave of contact ratio 1.5, its Fourier series, curve from the gears' "
           "geometry, its mean"},
          {"mesh_stiffness_factor",
           Kind::number,
           "1",
           "",
           1e-6,
           1e6,
           {},
           "stiffness of both meshes over the source's"},
          {"mesh_damping_Ns_per_m",
           Kind::number,
           "0",
           "N s/m",
           0,
           1e9,
           {},
           "of each mesh, in contact only, growing with penetration"}};
}

GearDriveParams gear_drive_params(const Parameters& s) {
  const std::string& variation = s.text("mesh_stiffness");
  return {.normal_backlash = mm(s.number("backlash_mm")),
          .variation = variation == "step"           ? MeshVariation::step
                       : variation == "fourier"      ? MeshVariation::fourier
                       : variation == "drawing"      ? MeshVariation::drawing
                       : variation == "drawing_mean" ? MeshVariation::drawing_mean
                                                     : MeshVariation::mean,
          .stiffness_factor = s.number("mesh_stiffness_factor"),
          .mesh_damping = s.number("mesh_damping_Ns_per_m")};
}

ModelCase build_gear_drive(Parameters s) {
  s.check();
  const double mean = s.number("torque_mean_Nm"), swing = s.number("torque_amplitude_Nm");
  const double order = s.number("torque_order");
  Model m("gear_drive");
  m.add_node("gear");
  add_gear_drive(m, "gear", gear_drive_params(s));
  m.add<Inertia>("J_gear", {"gear"}, {.inertia = kCamshaftGearInertia});
  m.add<EngineOrderTorque>("cam_load", {"gear"}, {.harmonics = {{order, swing, 0.0}}, .mean = mean});
  m.constant_speed("crank_gear", rpm(s.number("engine_rpm")));
  return {.model = std::move(m),
          .duration = s.number("duration_s"),
          // Fastest mode about 2 kHz: 50 steps in its period, also where the meshes are stiffer.
          .default_step = 1e-5 / std::sqrt(std::max(1.0, s.number("mesh_stiffness_factor"))),
          .deflection = "gear.angle_rad",
          .torques = {"mesh_1.force_N", "mesh_2.force_N"},
          .static_turn = 2.0 * kTwoPi,
          .channels = {"gear.angle_rad", "idler.angle_rad", "mesh_1.force_N", "mesh_2.force_N"}};
}

const ModelEntry& gear_drive_entry() {
  using Kind = Parameter::Kind;
  static const ModelEntry entry = [] {
    std::vector<Parameter> parameters = gear_drive_parameters();
    parameters.push_back({"engine_rpm", Kind::number, "750", "rpm", 1, 5000, {}, "crankshaft speed"});
    parameters.push_back({"torque_mean_Nm",
                          Kind::number,
                          "-2000",
                          "N m",
                          -1e7,
                          1e7,
                          {},
                          "mean torque on the camshaft gear; negative brakes it"});
    parameters.push_back({"torque_amplitude_Nm",
                          Kind::number,
                          "6000",
                          "N m",
                          0,
                          1e7,
                          {},
                          "amplitude of the cyclic torque on the camshaft gear"});
    parameters.push_back(
        {"torque_order", Kind::number, "9", "", 0.5, 100, {}, "cycles per camshaft revolution"});
    parameters.push_back({"duration_s", Kind::number, "1", "s", 1e-9, 1e4, {}, "simulated time"});
    return ModelEntry{"gear_drive", "two-stage gear drive with backlash, hammered by a cyclic torque",
                      parameters, build_gear_drive};
  }();
  return entry;
}

}  // namespace drev
