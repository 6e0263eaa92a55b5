#include "app/results/modes_notes.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/solvers/start.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/base/text_layout.hpp"
#include "app/run/run_computation.hpp"

namespace drev::app {

namespace {

constexpr double kOtherSlope = 1e-3;  // change of a slope that is reported, relative to it [-]
constexpr int kSlopeDigits = 6;

/// Whether its slope over x changes anywhere; a law that states no pieces may be bent in any way.
bool bent(const ScalarTerm& term) {
  const std::span<const LawPiece> pieces = term.force->pieces();
  const auto other = [&](const LawPiece& piece) { return piece.k != pieces.front().k; };
  return !term.force->gap() && term.phase_node < 0 &&
         (pieces.empty() || std::any_of(pieces.begin(), pieces.end(), other));
}

/// The load under which modes have the stiffness of couplings that follow it.
std::vector<std::string> load_notes(const System& system) {
  std::vector<std::string> notes;
  for (const FrequencyTerm& term : system.frequency_terms()) {
    const CarriedLoad load = term.stiffness->load_in_matrices();
    std::vector<std::string> taken;
    if (term.stiffness->follows_mean_torque())
      taken.push_back("its at_mean_torque, " + short_digits(load.mean_torque, kSlopeDigits) + " N m");
    if (term.stiffness->amplitudes().size() > 1)
      taken.push_back("its at_amplitude, " + short_digits(load.amplitude, kSlopeDigits) + " rad");
    if (taken.empty()) continue;
    notes.push_back(
        system.element_instances()[idx(index(term.element))].name + ": modes have its stiffness under " +
        join(taken, " and ") +
        (term.stiffness->follows_mean_torque() ? "; drev campbell takes the mean torque at each speed" : ""));
  }
  return notes;
}

std::vector<std::string> bend_notes(const ModelRequest& model) {
  const System& system = model.system;
  std::vector<const ScalarTerm*> terms;
  for (const ScalarTerm& term : system.scalars())
    if (bent(term)) terms.push_back(&term);
  if (terms.empty()) return {};
  std::optional<FoundStart> held;
  try {
    held = find_start(system, Start::static_equilibrium,
                      {.cycle = cycle_of(model), .duration = model.model_case.duration});
  } catch (const SolverError&) {  // none, as of a train that turns freely
  }
  const std::vector<Channel> channels = all_channels(system);
  std::vector<std::string> notes;
  for (const ScalarTerm* term : terms) {
    const std::string& name = system.element_instances()[idx(index(term->element))].name;
    const auto force = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) {
      return c.force_of() == static_cast<int>(term - system.scalars().data());
    });
    const std::string unit = force == channels.end() ? "N m" : force->unit();
    const auto slope_text = [&](double slope) {
      return short_digits(slope, kSlopeDigits) + (unit == "N" ? " N/m" : " N m/rad");
    };
    const double k = term->force->closed_stiffness();
    const std::string taken = name + ": modes are about zero deflection, with " + slope_text(k);
    if (!held) {
      notes.push_back(
          taken +
          "; its law is bent, and about a mean torque they are others. The model is not held, so that "
          "no equilibrium tells that torque");
      continue;
    }
    Assembler assembler(held->system);
    const State state = State::initial(held->system);
    assembler.set_time(0.0);
    const ScalarResponse at = term->force->evaluate(assembler.input(*term, state.z, state.v));
    if (!(std::abs(at.dy_dx - k) > kOtherSlope * std::max(std::abs(k), std::abs(at.dy_dx)))) continue;
    notes.push_back(taken + "; under the mean of the loads it carries " + short_digits(at.y, 4) + " " + unit +
                    ", where its law has " + slope_text(at.dy_dx) + ": about that they are others");
  }
  return notes;
}

}  // namespace

std::vector<std::string> modes_notes(const ModelRequest& model) {
  std::vector<std::string> notes = bend_notes(model);
  for (std::string& note : load_notes(model.system)) notes.push_back(std::move(note));
  return notes;
}

}  // namespace drev::app
