#pragma once
/// ContactEvents: every time at which the deflection of a law passes an edge of its gap, so that contact is made or lost:
/// located by exact propagation, else on the cubic through the deflections and rates at both ends of a step (from which a
/// contact that is made and lost within one step is missed). Of dry friction: every time at which a contact or lossy gear
/// sticks, slides, opens, or turns round.
#include <drev/core/law/friction.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/run/observer.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace drev {

struct ContactEvent {
  double t = 0.0;       ///< s
  std::size_t law = 0;  ///< of System::scalars()
  bool front = false;   ///< the flank: the upper edge of the gap, on which deflections are positive
  bool made = false;    ///< contact made; else lost
  double rate =
      0.0;  ///< of the deflection, m/s or rad/s: positive towards the front; of friction: slip speed
  /// Of System::frictions(), whose state from here on is `becomes`; -1: contact of a law.
  int friction = -1;
  FrictionState becomes = FrictionState::open;
};

class ContactEvents final : public Observer {
 public:
  /// sink: takes each event as the run comes to it; without one they are kept, see all(). Those of one time come in the
  /// order in which the edges are passed, those of different laws in that of System::scalars() within a step.
  explicit ContactEvents(const System& system, std::function<void(const ContactEvent&)> sink = {});
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override { return false; }
  const std::vector<ContactEvent>& all() const { return all_; }

 private:
  void note(const ContactEvent& event);
  void note_frictions(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to);
  void note_side(std::size_t law, int side, double t, double rate);
  const System& system_;
  std::function<void(const ContactEvent&)> sink_;
  const StepMotion* motion_ = nullptr;
  std::vector<std::optional<int>> sides_;  // of each law in the last step that knew
  std::vector<double> states_;             // of each friction contact in the last step
  std::vector<ContactEvent> all_;
};

}  // namespace drev
