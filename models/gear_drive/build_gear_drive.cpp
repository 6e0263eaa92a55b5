#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/gear_drive/build_gear_drive.hpp>

#include <algorithm>
#include <cmath>

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

MeshStiffness stiffness(double single, double both, double factor, MeshVariation variation) {
  single *= factor, both *= factor;
  if (variation == MeshVariation::step) return MeshStiffness::step(single, both, kContactRatio);
  if (variation == MeshVariation::fourier)
    return MeshStiffness::fourier_of_step(single, both, kContactRatio, kMeshHarmonics);
  return 0.5 * (single + both);
}

}  // namespace

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
                   .stiffness = stiffness(kSingle1, kDouble1, p.stiffness_factor, p.variation),
                   .normal_backlash = p.normal_backlash,
                   .damping = p.mesh_damping});
  m.add<GearMesh>("mesh_2", {"idler", camshaft_gear},
                  {.module = kModule2,
                   .teeth_1 = kSmallIdlerTeeth,
                   .teeth_2 = kCamshaftTeeth,
                   .pressure_angle = kPressureAngle,
                   .stiffness = stiffness(kSingle2, kDouble2, p.stiffness_factor, p.variation),
                   .normal_backlash = p.normal_backlash,
                   .damping = p.mesh_damping,
                   .mesh_phase = kSecondMeshPhase});
}

std::vector<Parameter> gear_drive_settings() {
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
           {"mean", "step", "fourier"},
           "constant mean, square wave of contact ratio 1.5, or its Fourier series"},
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
          .variation = variation == "step"      ? MeshVariation::step
                       : variation == "fourier" ? MeshVariation::fourier
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
    std::vector<Parameter> parameters = gear_drive_settings();
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
