// Peaks of steps that are passed over.
// Covers solvers/run/peaks.hpp.
#include <drev/core/assembler.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <string>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("A force that jumps at the end of a step counts, though the step itself needs no look inside") {
  // As where a mesh's stiffness steps up: ahead of it the force stays within what it was.
  struct Given final : StepMotion {
    Point at(double) override { throw std::logic_error("no look inside is needed"); }
    std::optional<Range> force_range(int) override { return Range{45.0, 55.0, 1e-6}; }
  } motion;
  Model m("mesh");
  for (const char* node : {"pinion", "wheel"}) m.add_node(node);
  m.constant_speed("pinion", 0.0);
  m.add<Inertia>("J", {"wheel"}, {.inertia = 0.2});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e4, .normal_backlash = 1e-6});
  const System system = m.build();
  const Assembler assembler(system);
  const auto point = [&](double t, double force) {
    EvaluatedState p;
    p.state = State::initial(system);
    p.state.t = t;
    evaluate_laws(assembler, p);
    p.state.z[0] = force / (1e4 * system.scalars()[0].z[0].coeff);
    evaluate_laws(assembler, p);
    return p;
  };
  Peaks peaks(find_channels(system, {"mesh.force_N"}));
  peaks.look_through(motion);
  const EvaluatedState before = point(0.0, 60.0), ahead = point(1e-3, 40.0), jumped = point(2e-3, 90.0);
  peaks.start(assembler, before);
  CHECK(peaks.peaks()[0].max == Approx(60.0).epsilon(1e-3));
  peaks.step(assembler, before, ahead);
  const Vector beyond = Vector::Zero(2);
  CHECK_FALSE(peaks.looks_inside(ahead, jumped, beyond.data()));
  peaks.step(assembler, ahead, jumped);
  CHECK(peaks.peaks()[0].max == Approx(90.0).epsilon(1e-3));
  CHECK(peaks.peaks()[0].max_time == 2e-3);
}

TEST_CASE("A torque of friction that is constant is no peak to look for inside steps") {
  // A freewheel that overruns, a clutch that slides, and a stiff shaft that sets the steps.
  Model m("friction");
  for (const char* node : {"a", "b", "c", "wall"}) m.add_node(node);
  for (const char* node : {"a", "b"}) m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0});
  m.set_initial("a", 0.0, 1.0);
  m.hold("wall");
  m.set_initial("c", 1e-3, 0.0);
  m.add<Inertia>("J_c", {"c"}, {.inertia = 1e-3});
  m.add<ShaftSpring>("shaft", {"wall", "c"}, {.stiffness = 1e6});
  m.add<Freewheel>("freewheel", {"b", "a"}, {});
  m.add<Clutch>("clutch", {"a", "wall"}, {.torque = 0.1});
  const System system = m.build();
  struct Counting final : Observer {
    explicit Counting(const System& of)
        : peaks(find_channels(of, {"freewheel.torque_Nm", "clutch.torque_Nm"})) {}
    void look_through(StepMotion& motion) override { peaks.look_through(motion); }
    void start(const Assembler& a, const EvaluatedState& at) override { peaks.start(a, at); }
    void restart(const Assembler& a, const EvaluatedState& at) override { peaks.restart(a, at); }
    bool looks_inside(const EvaluatedState& from, const EvaluatedState& to, const double* beyond) override {
      const bool inside = peaks.looks_inside(from, to, beyond);
      looks += inside ? 1 : 0;
      return inside;
    }
    void step(const Assembler& a, const EvaluatedState& from, const EvaluatedState& to) override {
      peaks.step(a, from, to);
    }
    Peaks peaks;
    int looks = 0;
  } watch(system);
  const RunSummary run = propagate(system, {.t_end = 0.1}, {&watch});
  REQUIRE(run.ok());
  CHECK(run.steps > 500);
  CHECK(watch.looks <= 2);
  CHECK(watch.peaks.peaks()[1].amplitude() == Approx(0.1).epsilon(1e-15));
}
