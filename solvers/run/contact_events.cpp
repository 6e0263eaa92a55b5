#include <drev/core/assembler.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>

namespace drev {

namespace {

constexpr int kBisectionsOfStep = 48;

/// Cubic through values and rates at the ends of a step of length h.
struct StepCubic {
  double y_0, r_0, y_1, r_1, h;
  /// At s in [0, 1].
  double value(double s) const {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * y_0 + (s3 - 2 * s2 + s) * h * r_0 + (3 * s2 - 2 * s3) * y_1 +
           (s3 - s2) * h * r_1;
  }
  double rate(double s) const {
    const double s2 = s * s;
    return 6 * (s - s2) * (y_1 - y_0) / h + (3 * s2 - 4 * s + 1) * r_0 + (3 * s2 - 2 * s) * r_1;
  }
};

}  // namespace

ContactEvents::ContactEvents(const System& system, std::function<void(const ContactEvent&)> sink)
    : system_(system), sink_(std::move(sink)), sides_(system.scalars().size()) {}

void ContactEvents::note(const ContactEvent& event) {
  if (sink_)
    sink_(event);
  else
    all_.push_back(event);
}

/// The law is on this side of its gap from t on: which edges it passed to come there.
void ContactEvents::note_side(std::size_t law, int side, double t, double rate) {
  const int before = sides_[law].value_or(side);
  sides_[law] = side;
  for (int now = before; now != side; now += side > before ? 1 : -1) {
    const int next = now + (side > before ? 1 : -1);
    note({.t = t, .law = law, .front = std::max(now, next) > 0, .made = next != 0, .rate = rate});
  }
}

bool ContactEvents::fits(const System& system) const { return system.layout() == system_.layout(); }

void ContactEvents::start(const Assembler& /*assembler*/, const EvaluatedState& point) {
  for (std::size_t j = 0; j < sides_.size(); ++j)
    if (const auto gap = system_.scalars()[j].force->gap(); gap && !sides_[j])
      sides_[j] = gap->side(point.inputs[j].x);
  states_.clear();
  for (const FrictionTerm& term : system_.frictions())
    states_.push_back(point.state.history[term.history_begin + FrictionHistory::kState]);
}

/// A state holds over a step: it begins where the step does.
void ContactEvents::note_frictions(const Assembler& assembler, const EvaluatedState& from,
                                   const EvaluatedState& to) {
  for (std::size_t i = 0; i < system_.frictions().size(); ++i) {
    const FrictionTerm& term = system_.frictions()[i];
    const double state = to.state.history[term.history_begin + FrictionHistory::kState];
    if (term.friction->rigid() || state == states_[i]) continue;
    states_[i] = state;
    ContactEvent event{.t = from.state.t, .law = 0};
    event.friction = static_cast<int>(i);
    event.becomes = static_cast<FrictionState>(static_cast<int>(state));
    if (event.becomes != FrictionState::stuck)
      for (const Entry& e : term.nodes)
        event.rate += e.coeff * (assembler.node_motion(e.index, from.state).rate +
                                 system_.ratio(e.index) * assembler.nominal().rate);
    note(event);
  }
}

void ContactEvents::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  if (!(to.state.t > from.state.t)) return;
  note_frictions(assembler, from, to);
  const double h = to.state.t - from.state.t;
  for (std::size_t j = 0; j < system_.scalars().size(); ++j) {
    const auto gap = system_.scalars()[j].force->gap();
    if (!gap) continue;
    const ScalarInput &a = from.inputs[j], &b = to.inputs[j];
    if (const auto side = motion_ ? motion_->side(static_cast<int>(j)) : std::nullopt) {
      note_side(j, *side, from.state.t, a.x_dot);
      continue;
    }
    const StepCubic x{a.x, a.x_dot, b.x, b.x_dot, h};
    std::vector<ContactEvent> here;
    for (const bool front : {false, true}) {
      const double edge = front ? gap->high : gap->low;
      if ((a.x > edge) == (b.x > edge)) continue;
      double low = 0.0, up = 1.0;
      for (int i = 0; i < kBisectionsOfStep; ++i) {
        const double s = 0.5 * (low + up);
        ((x.value(s) > edge) == (a.x > edge) ? low : up) = s;
      }
      here.push_back({from.state.t + up * h, j, front, (b.x > edge) == front, x.rate(up)});
    }
    if (here.size() == 2 && here[1].t < here[0].t) std::swap(here[0], here[1]);
    for (const ContactEvent& event : here) note(event);
  }
}

}  // namespace drev
