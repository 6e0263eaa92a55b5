#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>

#include <algorithm>
#include <cmath>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

/// What the reference saw in one contact.
struct Contact {
  double front = 0.0, back = 0.0, apart = 0.0;
};

Contact contact_of(const Spec& spec, const ReferenceResult& r, const std::string& element,
                   bool apart_at_start) {
  Contact c;
  bool apart = apart_at_start;
  Real from = 0;
  for (const EdgeTime& e : r.edges) {
    if (e.element != element) continue;
    if (apart) c.apart += static_cast<double>(e.t - from);
    if (e.outward) (e.flank > 0 ? c.front : c.back) += 1.0;
    apart = !e.outward, from = e.t;
  }
  if (apart) c.apart += static_cast<double>(spec.duration - from);
  return c;
}

/// At the start: whether the contact is open.
bool open_at_start(const ReferenceModel& model, const std::string& element) {
  const bool mesh = element.starts_with("mesh");
  const int i = std::stoi(element.substr(mesh ? 4 : 8));
  if (mesh) return model.mesh_side(i) == 0;
  const Polyline& p = model.spec().polylines[static_cast<std::size_t>(i)];
  const auto segment = static_cast<std::size_t>(model.segment(i));
  return p.y[segment] == 0.0 && p.y[segment + 1] == 0.0;
}

}  // namespace

void cover_contacts(const Case& c, Table& table) {
  if (c.chaotic()) return;  // as in cover_runs
  constexpr double tolerance = 1e-11;
  const ReferenceModel model(c.spec);
  const drev::System system = to_drev(c.spec);
  drev::ContactStatistics statistics(system, true);
  try {
    if (!drev::propagate(system, {.tolerance = tolerance, .t_end = c.spec.duration}, {&statistics}).ok())
      return;
  } catch (const drev::SolverError&) {
    return;  // counted by cover_runs
  }
  const double share = tolerance * c.growth;
  for (const drev::ContactRecord& record : statistics.records()) {
    const bool apart = open_at_start(model, record.element);
    const Contact fine = contact_of(c.spec, c.fine, record.element, apart);
    const Contact check = contact_of(c.spec, c.check, record.element, apart);
    const std::string where = c.spec.name + " (" + c.spec.family + ") " + record.element;
    const auto compare = [&](const char* kind, double value, double stated, double truth, double other) {
      table.add(kind, {where, value, stated, truth, 2.0 * std::abs(truth - other)});
    };
    compare("contacts: front impacts", static_cast<double>(record.front_impacts), 0.0, fine.front,
            check.front);
    compare("contacts: back impacts", static_cast<double>(record.back_impacts), 0.0, fine.back, check.back);
    compare("contacts: time apart", record.time_separated, share * c.spec.duration, fine.apart, check.apart);
    for (std::size_t i = 0; i < model.channels().size(); ++i) {
      const std::string& name = model.channels()[i].name;
      if (name != record.element + ".force_N" && name != record.element + ".torque_Nm") continue;
      const double truth = static_cast<double>(c.fine.peaks[i].amplitude());
      table.add("contacts: largest force",
                {where, record.largest_force, share * truth, truth, c.truth_error(i)});
    }
  }
}

}  // namespace coverage
