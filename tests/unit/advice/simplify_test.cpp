// Simpler models made from a model are those that one would write by hand.
#include "advice/simplify.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "advice/figure_estimate.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

Model camshaft(const char* drive) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("cylinders", "6");
  s.set("drive", drive);
  return build_camshaft(s).model;
}

double peak(const Model& model, const std::string& channel, double t_end) {
  return figure_of_run(model.build(), {.name = "exact", .tolerance = 1e-12},
                       {.channels = {channel}, .t_end = t_end});
}

/// drive --mesh-- gear === shaft === end, with a mean torque on the end.
Model geared(double backlash, double gear_start, double end_start) {
  Model m("geared");
  for (const char* node : {"drive", "gear", "end"}) m.add_node(node);
  m.add<Inertia>("J_gear", {"gear"}, {.inertia = 0.5});
  m.add<Inertia>("J_end", {"end"}, {.inertia = 2.0});
  m.add<GearMesh>(
      "mesh", {"drive", "gear"},
      {.base_radius_1 = 0.1, .base_radius_2 = 0.2, .stiffness = 1e8, .normal_backlash = backlash});
  m.add<ShaftSpring>("shaft", {"gear", "end"}, {.stiffness = 1e5});
  m.add<AppliedTorque>("load", {"end"},
                       {.torque = [](double t) { return -500.0 - 100.0 * std::sin(90.0 * t); }});
  m.constant_speed("drive", 50.0);
  m.set_initial("gear", gear_start, 0.0);
  m.set_initial("end", end_start, 0.0);
  return m;
}

}  // namespace

TEST_CASE("The drive held is the camshaft with its gear held") {
  const Model gears = camshaft("gears");
  const std::string twist = "inlet_6-fuel_1.twist_rad";
  const auto held = with_drive_held(gears, nodes_of(gears, {twist}));
  REQUIRE(held);
  CHECK(held->element_instances().size() + 4 ==
        gears.element_instances().size());  // two inertias, two meshes
  CHECK(peak(*held, twist, 0.05) == Approx(peak(camshaft("held"), twist, 0.05)).epsilon(1e-9));
  // Rigid meshes leave the crank gear's constant speed nothing else to do.
  CHECK(peak(*with_rigid_meshes(gears), twist, 0.05) == Approx(peak(*held, twist, 0.05)).epsilon(1e-9));
  CHECK_FALSE(with_drive_held(*held, nodes_of(*held, {twist})));
  CHECK_FALSE(with_drive_held(gears, nodes_of(gears, {"mesh_1.force_N"})));
  CHECK_FALSE(with_mean_stiffness(gears));
}

TEST_CASE("A mesh that starts on its flank and stays there needs no gap") {
  // In equilibrium the load presses the back flank together: 0.2 q = -half gap - load/(r k).
  const double backlash = 2e-4, load = 500.0 / 0.2 / 1e8;
  const double gear = -(0.5 * backlash + load) / 0.2, end = gear - 500.0 / 1e5;
  const Model full = geared(backlash, gear, end);
  const Flanks flanks = flanks_at_start(full.build());
  CHECK(flanks.at("mesh") == -1);
  const Model closed = *without_backlash(full, flanks);
  for (const char* channel : {"gear.angle_rad", "shaft.torque_Nm", "mesh.force_N"})
    CHECK(peak(closed, channel, 0.2) == Approx(peak(full, channel, 0.2)).epsilon(1e-9));
  CHECK(flanks_at_start(geared(backlash, 0.0, 0.0).build()).at("mesh") == 0);
  CHECK_FALSE(without_backlash(closed));
}

TEST_CASE("Parts that are tied again keep the twists that they start with") {
  const Model full = geared(2e-4, -1e-3, -4e-3);
  for (const Model& m : {*with_rigid_meshes(full), *with_drive_held(full, {"gear", "end"})}) {
    const System system = m.build();
    CHECK(find_channel(system, "end-gear.twist_rad").evaluate(Assembler(system), State::initial(system)) ==
          Approx(-3e-3).epsilon(1e-12));
  }
}

TEST_CASE("A dead band without its gap is a spring") {
  Model m("stops");
  m.add_node("mass");
  m.add<Inertia>("J", {"mass"}, {.inertia = 2.0});
  m.add<PolylineSpring>("spring", {"mass"}, PolylineSpring::dead_band(800.0, 0.01));
  const Model closed = *without_backlash(m);
  CHECK(solve_modes(closed.build()).frequency_Hz.at(0) == Approx(to_hz(20.0)).epsilon(1e-12));
  CHECK_FALSE(closed.build().scalars().at(0).force->gap());
}

TEST_CASE("Shafts with fewer segments, and lumped") {
  Model m("shaft");
  m.add_node("a");
  m.add_node("b");
  m.add<DistributedShaft>(
      "s", {"a", "b"},
      {.shear_modulus = 8e10, .density = 7850, .outer_diameter = 0.1, .length = 2.0, .segments = 30});
  m.add<Inertia>("J", {"b"}, {.inertia = 3.0});
  m.hold("a");
  m.set_initial("s_10", 0.01, 0.0);
  m.set_initial("s_11", 0.02, 0.0);
  CHECK(finest_shaft(m) == 30);
  const RenamedModel coarse = *with_coarser_shafts(m, 4);  // s_1 is at 7.5 of 30 segments
  CHECK(finest_shaft(coarse.model) == 4);
  CHECK(coarse.renamed.at("s_1.torque_Nm") == "s_1.torque_Nm");
  CHECK(coarse.renamed.at("s_9.torque_Nm") == "s_2.torque_Nm");
  CHECK(coarse.renamed.at("s_30.torque_Nm") == "s_4.torque_Nm");
  CHECK_FALSE(with_coarser_shafts(m, 30));
  const RenamedModel fine = *with_coarser_shafts(m, 20);  // s_7 is at 10.5
  const System system = fine.model.build();
  CHECK(find_channel(system, "s_7.angle_rad").evaluate(Assembler(system), State::initial(system)) ==
        Approx(0.015).epsilon(1e-12));
  const double area = kPi * std::pow(0.1, 4) / 32.0;
  const RenamedModel lumped = *with_lumped_shafts(m);
  CHECK(lumped.renamed.at("s_17.torque_Nm") == "s.torque_Nm");
  CHECK(solve_modes(lumped.model.build()).frequency_Hz.at(0) ==
        Approx(to_hz(std::sqrt(8e10 * area / 2.0 / (3.0 + 7850 * area)))).epsilon(1e-12));
}
