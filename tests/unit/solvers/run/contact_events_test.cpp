// Contact events against closed forms.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/contact_statistics.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Contact events have their times, flanks and rates, by located changes and on the cubic of steps") {
  // A wheel of inertia J at rest in the middle of its backlash 2 b, driven by a constant torque against a fixed pinion: it
  // meets the back flank at t = sqrt(2 b J/tau) with the rate tau t/J, leaves it half a period of the contact later
  // (after 2 (pi - atan2(..))/omega), and falls back as a ball does.
  const double inertia = 0.5, torque = 2.0, stiffness = 4e4, gap = 1e-3;
  Model m("bouncing wheel");
  for (const char* node : {"pinion", "wheel"}) m.add_node(node);
  m.hold("pinion");
  m.add<Inertia>("J", {"wheel"}, {.inertia = inertia});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 1.0,
                   .base_radius_2 = 1.0,
                   .teeth_1 = 20,
                   .teeth_2 = 20,
                   .stiffness = stiffness,
                   .normal_backlash = 2.0 * gap});
  m.add<AppliedTorque>("load", {"wheel"}, {.table = TimeTable({0.0}, {torque})});
  const System system = m.build();

  const double meets = std::sqrt(2.0 * gap * inertia / torque), rate = torque * meets / inertia;
  // In contact x = s (1 - cos w t) + rate/w sin w t, s = tau/k: zero again where tan(w t/2) = -rate/(w s).
  const double w = std::sqrt(stiffness / inertia), sag = torque / stiffness;
  const double in_contact = 2.0 * (3.14159265358979323846 - std::atan(rate / (w * sag))) / w;
  const double end = 3.0 * meets + 1.5 * in_contact;
  for (const Method& method :
       {Method{.name = kExact, .tolerance = 1e-12}, Method{.name = "dormand_prince", .tolerance = 1e-9}}) {
    INFO(method.name);
    ContactEvents kept(system);
    std::vector<ContactEvent> sunk;
    ContactEvents handed_on(system, [&](const ContactEvent& event) { sunk.push_back(event); });
    REQUIRE(run_method(system, method, {.t_end = end}, {&kept, &handed_on}).ok());
    const double near = method.exact() ? 1e-10 : 1e-6;
    REQUIRE(kept.all().size() == 3);
    REQUIRE(sunk.size() == 3);
    const double times[] = {meets, meets + in_contact, 3.0 * meets + in_contact};
    const double sign = kept.all()[0].front ? 1.0 : -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const ContactEvent& event = kept.all()[i];
      INFO("event " << i);
      CHECK(event.t == Approx(times[i]).epsilon(near));
      CHECK(event.made == (i != 1));
      CHECK(event.front == kept.all()[0].front);
      CHECK(event.rate == Approx(i == 1 ? -sign * rate : sign * rate).epsilon(10.0 * near));
      CHECK(sunk[i].t == event.t);
    }
  }
}
