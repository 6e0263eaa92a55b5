#pragma once
/// Forty drivetrains on which advice is checked, five of each of eight kinds, the same in every run:
///
///   drive (constant speed) --mesh-- gear === shaft === mid === shaft === end        or without the mesh
///
/// Shafts are distributed (20 to 160 segments) or chains of stations. Loads on the end have a mean and orders
/// of the shaft's speed; cams are tables on all stations.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/stability/random_model.hpp"

namespace drev::test {

inline constexpr int kAdviceModels = 40;

class AdviceModelMaker {
 public:
  explicit AdviceModelMaker(int which)
      : kind_(which / 5), seed_(which % 5), random_(static_cast<unsigned>(1000 + which)) {}

  ModelCase make() {
    static constexpr const char* kKinds[] = {"distributed shaft",
                                             "distributed shaft behind gears",
                                             "chain behind gears, loaded one way",
                                             "chain behind gears, rattling",
                                             "stepped mesh, far from resonance",
                                             "stepped mesh, near parametric resonance",
                                             "chain behind two meshes, started in the gap",
                                             "chain of cams"};
    const bool gears = kind_ != 0 && kind_ != 7;
    speed_ = random_(40.0, 120.0);
    ratio_ = random_(0.4, 0.8);
    tooth_k_ = random_.decade(8.0, 9.0);
    build(kKinds[kind_], gears, ratio_);
    if (kind_ == 4 || kind_ == 5) {
      // Teeth pass at 2 f_1, or a third beyond the highest of the lower resonances.
      const double f = solve_modes(model_case_.model.build(), {.count = 1}).frequency_Hz[0];
      const double tooth = kind_ == 5 ? 2.0 * f * random_(0.98, 1.02) : 2.0 * f * random_(2.7, 4.3);
      speed_ = hz(tooth) / kTeeth;
      build(kKinds[kind_], gears, ratio_);
    }
    if (kind_ == 1 || kind_ == 2 || kind_ == 4 || kind_ == 5) start_in_equilibrium();
    return model_case_;
  }

 private:
  static constexpr int kTeeth = 31;

  void build(const char* kind, bool gears, double ratio) {
    Random keep = random_;  // built twice alike
    Model m(std::string(kind) + " " + std::to_string(seed_ + 1));
    inertia_ = keep(2.0, 6.0);
    stiffness_ = keep.decade(5.0, 6.0);
    m.add_node("gear");
    m.add<Inertia>("J_gear", {"gear"}, {.inertia = keep(0.3, 1.5)});
    if (gears) {
      m.add_node("drive");
      m.add<Inertia>("J_drive", {"drive"}, {.inertia = 1.0});
      std::string from = "drive";
      if (kind_ == 6) {
        m.add_node("idler");
        m.add<Inertia>("J_idler", {"idler"}, {.inertia = keep(0.3, 1.0)});
        mesh(m, "mesh_1", "drive", "idler", 1.0, keep);
        from = "idler";
      }
      mesh(m, kind_ == 6 ? "mesh_2" : "mesh", from, "gear", ratio, keep);
      m.constant_speed("drive", speed_);
    } else {
      m.constant_speed("gear", speed_);
    }
    const double turn = gears ? speed_ * ratio : speed_;
    std::vector<std::string> torques;
    const std::vector<std::string> loaded =
        kind_ <= 1 ? distributed(m, torques, keep) : chain(m, torques, keep);
    const double first = std::sqrt(stiffness_ / (3.0 * inertia_));  // rad/s, rough
    m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 2.0 * keep(0.01, 0.04) * first});
    load(m, loaded, first / turn, keep);
    model_case_ = ModelCase{.model = std::move(m),
                            .duration = keep(8.0, 14.0) * kTwoPi / first,
                            .default_step = 1e-5,
                            .deflection = "end-gear.twist_rad",
                            .torques = torques,
                            .static_turn = kTwoPi / ratio};
  }

  void mesh(Model& m, const std::string& name, const std::string& a, const std::string& b, double ratio,
            Random& random) {
    const double k = tooth_k_, swing = random(0.1, 0.3), contact_ratio = random(1.3, 1.7);
    const bool stepped = kind_ == 4 || kind_ == 5;
    m.add<GearMesh>(
        name, {a, b},
        {.base_radius_1 = 0.2 * ratio,
         .base_radius_2 = 0.2,
         .teeth_1 = kTeeth,
         .stiffness = !stepped ? MeshStiffness(k)
                      : seed_ % 2
                          ? MeshStiffness::fourier_of_step((1 - swing) * k, (1 + swing) * k, contact_ratio, 3)
                          : MeshStiffness::step((1 - swing) * k, (1 + swing) * k, contact_ratio),
         .normal_backlash = random(0.5e-4, 2e-4),
         .damping = kind_ == 3 || seed_ == 0 ? 0.02 * std::sqrt(k * 50.0) : 0.0,
         .damping_law = MeshDamping::limited});
  }

  std::vector<std::string> distributed(Model& m, std::vector<std::string>& torques, Random& random) {
    m.add_node("mid");
    m.add_node("end");
    const int n = kind_ == 0 ? 20 + 35 * seed_ : 20 + 15 * seed_;
    // k = G I_p/L of both shafts in series, I_p = pi D^4/32.
    const double length = random(0.8, 1.6), modulus = 8e10;
    const double area = 2.0 * stiffness_ * length / modulus;
    const double diameter = std::pow(32.0 * area / kPi, 0.25);
    for (const bool second : {false, true}) {
      const std::string name = second ? "shaft_b" : "shaft_a";
      m.add<DistributedShaft>(name, {second ? "mid" : "gear", second ? "end" : "mid"},
                              {.shear_modulus = modulus,
                               .density = 7850,
                               .outer_diameter = diameter,
                               .length = length,
                               .segments = second ? n : (n + 1) / 2});
      torques.push_back(name + "_1.torque_Nm");
    }
    m.add<Inertia>("J_mid", {"mid"}, {.inertia = random(0.2, 1.0) * inertia_});
    m.add<Inertia>("J_end", {"end"}, {.inertia = inertia_});
    return {"end"};
  }

  std::vector<std::string> chain(Model& m, std::vector<std::string>& torques, Random& random) {
    const int stations = kind_ == 4 || kind_ == 5 ? 3 + seed_ : 12 + 6 * seed_;
    std::vector<std::string> nodes;
    std::string last = "gear";
    for (int i = 1; i <= stations; ++i) {
      const std::string node = i == stations ? "end" : "station_" + std::to_string(i);
      m.add_node(node);
      m.add<Inertia>("J_" + node, {node}, {.inertia = 2.0 * inertia_ / stations * random(0.5, 1.5)});
      m.add<ShaftSpring>("shaft_" + std::to_string(i), {last, node},
                         {.stiffness = stiffness_ * stations * random(0.6, 1.6)});
      torques.push_back("shaft_" + std::to_string(i) + ".torque_Nm");
      nodes.push_back(node);
      last = node;
    }
    return kind_ == 7 ? nodes : std::vector<std::string>{"end"};
  }

  void load(Model& m, const std::vector<std::string>& nodes, double orders, Random& random) {
    const double torque = random(500.0, 3000.0), share = 1.0 / static_cast<double>(nodes.size());
    const double mean = kind_ == 3 ? 0.05 : kind_ == 6 ? 0.5 : 1.0, swing = kind_ == 3 ? 1.0 : 0.15;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (kind_ == 7) {
        std::vector<double> x, y;
        for (int k = 0; k < 90; ++k) {
          x.push_back(kTwoPi * k / 90.0);
          y.push_back(torque * (k < 30 ? std::sin(kTwoPi * k / 30.0) : 0.0));
        }
        m.add<CamTorque>("cam_" + nodes[i], {nodes[i]},
                         {.angle_table = PeriodicTable(x, y, kTwoPi), .phase = 2.4 * static_cast<double>(i)});
        continue;
      }
      const double order = std::max(0.5, 0.5 * std::round(2.0 * orders * random(0.2, 0.7)));
      m.add<EngineOrderTorque>("load_" + nodes[i], {nodes[i]},
                               {.harmonics = {{order, swing * share * torque, random(0.0, 6.0)},
                                              {2.0 * order, 0.4 * swing * share * torque, random(0.0, 6.0)}},
                                .mean = -mean * share * torque});
    }
  }

  void start_in_equilibrium() {
    const System system = model_case_.model.build();
    StaticSolver statics(system);
    const StaticResult rest = statics.solve();
    for (int i = 0; i < system.node_count(); ++i) {
      const NodeMap& map = system.node_map(i);
      if (map.unknown >= 0)
        model_case_.model.set_initial(system.node_names()[idx(i)], map.coeff * rest.state.z[map.unknown],
                                      0.0);
    }
  }

  int kind_, seed_;
  Random random_;
  double speed_ = 0.0, ratio_ = 1.0, tooth_k_ = 1e8, inertia_ = 1.0, stiffness_ = 1e5;
  ModelCase model_case_{.model = Model("")};
};

inline ModelCase advice_model(int which) { return AdviceModelMaker(which).make(); }

}  // namespace drev::test
