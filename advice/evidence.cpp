#include "advice/evidence.hpp"

#include <drev/advice/advise.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drev {

namespace {

constexpr int kModes = 10, kOrders = 3;  // modes and orders whose parametric resonances are looked at

std::string number(double value, const char* form = "%.4g") {
  char text[64];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

void append(std::string& text, const std::string& sentence) {
  if (!sentence.empty()) text += (text.empty() ? "" : "; ") + sentence;
}

std::string element_of(const std::string& channel) { return channel.substr(0, channel.rfind('.')); }

}  // namespace

std::string percent(double part) { return number(100.0 * part, "%.2g") + " %"; }

Evidence::Evidence(const System& system) : system_(system), flanks_(flanks_at_start(system)) {
  const std::vector<Channel> all = all_channels(system);
  for (const Channel& c : all)
    if (c.force_of() >= 0 && system.scalars()[idx(c.force_of())].force->gap()) channels_.push_back(c.name());
}

std::string Evidence::contacts(const std::vector<Peak>& forces) const {
  std::string text;
  const std::vector<Channel> found = find_channels(system_, channels_);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::string range = number(forces[i].min) + " to " + number(forces[i].max) + " " + found[i].unit();
    if (forces[i].min > 0.0 || forces[i].max < 0.0)
      append(text, "the force in " + element_of(channels_[i]) + " never falls to zero (" + range +
                       "): its flank never parts" +
                       (flanks_.at(element_of(channels_[i])) != 0
                            ? ", and the run starts on it: the equations are the same without the gap"
                            : ""));
    else if (forces[i].min < 0.0 && forces[i].max > 0.0)
      append(text, "the force in " + element_of(channels_[i]) + " reverses (" + range + ")");
    else
      append(text, "the force in " + element_of(channels_[i]) + " falls to zero (" + range + ")");
  }
  return text;
}

std::string Evidence::parametric() const {
  if (!system_.reference()) return "";
  const double speed = system_.reference_speed();
  std::vector<double> f;
  try {
    const ModeSet modes = solve_modes(system_, {});
    f = modes.frequency_Hz;
  } catch (const SolverError&) {
    return "";
  }
  if (f.size() > kModes) f.resize(kModes);
  std::string text;
  for (const ScalarTerm& term : system_.scalars()) {
    const ElementInstance& p = system_.element_instances()[idx(index(term.element))];
    const auto* mesh = dynamic_cast<const GearMesh*>(term.force);  // on bearings, too
    if (mesh == nullptr || !mesh->params().stiffness.varies()) continue;
    const double tooth = to_hz(mesh->params().teeth_1 * std::abs(system_.ratio(term.phase_node)) * speed);
    double nearest = 0.0;
    std::string which;
    for (std::size_t i = 0; i < f.size(); ++i)
      for (int n = 1; n <= kOrders; ++n) {
        const double resonance = 2.0 * f[i] / n;
        if (!which.empty() && std::abs(resonance - tooth) >= std::abs(nearest - tooth)) continue;
        nearest = resonance;
        which = "2 f_" + std::to_string(i + 1) + "/" + std::to_string(n);
      }
    if (which.empty() || !(tooth > 0.0)) continue;
    append(text, "the teeth of " + p.name + " pass at " + number(tooth) +
                     " Hz, the nearest parametric resonance " + which + " is at " + number(nearest) +
                     " Hz, " + percent(std::abs(nearest - tooth) / tooth) + " away");
  }
  return text;
}

std::string Evidence::of_full(const std::vector<Peak>& forces) const {
  std::string text = contacts(forces);
  append(text, parametric());
  return text;
}

std::string Evidence::of_level(bool gap, bool variation, const std::vector<Peak>& forces) const {
  std::string text;
  if (gap) append(text, contacts(forces));
  if (variation) append(text, parametric());
  return text;
}

std::string Evidence::sentence(const Advice& a) const {
  const Rung &best = a.best(), &full = a.full();
  const auto value = [&](const Rung& r) {
    return number(r.value, "%.6g") + " +- " + number(r.error, "%.2g") + " " + a.unit;
  };
  if (a.chosen + 1 == a.rungs.size()) {
    std::string text = "Use the full model: " + a.figure + " is " + value(full);
    if (a.statistic) text += " in 95 of 100 runs that start beside each other";
    return text + ", and none of the simpler ones tried is cheaper and keeps it within " + percent(a.within) +
           ".";
  }
  return "Use " + best.name + ", without " + best.leaves_out + ": " + a.figure + " is " + value(best) +
         ", with the full model " + value(full) + (a.statistic ? " (95 of 100 runs)" : "") +
         ". The difference, " + percent(best.difference) + " +- " + percent(best.difference_error) +
         ", is within " + percent(a.within) + ", at " + number(best.cost, "%.2g") + " of the processor time.";
}

}  // namespace drev
