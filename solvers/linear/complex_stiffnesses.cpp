#include "solvers/linear/complex_stiffnesses.hpp"

#include <drev/core/assembler.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kSameChain = 1e-9;  // relative rounding of the stiffness of an element's chain [-]

}  // namespace

ComplexStiffnesses::ComplexStiffnesses(const System& system, std::vector<bool> used)
    : system_(system),
      held_(idx(system.size()), false),
      term_held_(system.frequency_terms().size(), false),
      term_constant_(term_held_) {
  if (count() == 0) return;
  used.resize(held_.size());
  find_slots();
  Vector damping, stiffness;
  const Assembler assembler(system);
  assembler.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping);
  assembler.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness);
  for (const ScalarTerm& term : system.scalars())
    for (const Entry& e : term.z) used[idx(e.index)] = true;
  for (const LoadTerm& load : system.loads())
    for (const Entry& e : system.row_of(load.node)) used[idx(e.index)] = true;
  for (std::size_t t = 0; t < count(); ++t) {
    const std::vector<int> inner = inner_of(t, used);
    const FrequencyStiffness& own = *system.frequency_terms()[t].stiffness;
    if (!own.beyond_held(1.0, {}) || !alone(t, inner, damping, stiffness)) continue;
    term_held_[t] = true;
    term_constant_[t] = !own.follows_frequency();
    for (const int unknown : inner) held_[idx(unknown)] = true;
  }
}

void ComplexStiffnesses::find_slots() {
  const SparseMatrix& pattern = system_.pattern();
  for (std::size_t t = 0; t < count(); ++t)
    for (const Entry& c : system_.frequency_terms()[t].z)
      for (const Entry& r : system_.frequency_terms()[t].z) {
        const int* first = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index];
        const int* last = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index + 1];
        slots_.push_back(static_cast<int>(std::lower_bound(first, last, r.index) - pattern.innerIndexPtr()));
        slot_terms_.push_back(static_cast<int>(t));
        slot_times_.push_back(r.coeff * c.coeff);
      }
}

std::vector<int> ComplexStiffnesses::inner_of(std::size_t term, const std::vector<bool>& used) const {
  const std::vector<FrequencyTerm>& terms = system_.frequency_terms();
  const ElementId element = terms[term].element;
  const auto same = [&](const FrequencyTerm& other) { return other.element == element; };
  if (std::count_if(terms.begin(), terms.end(), same) > 1) return {};
  std::vector<int> inner;
  for (const NodeId id : system_.element_instances()[idx(index(element))].internal) {
    const std::vector<Entry> row = system_.row_of(index(id));
    if (row.size() != 1) return {};
    const int unknown = row[0].index;
    const std::vector<Entry>& ends = terms[term].z;
    // A damper's ring is an end of its spring.
    if (std::any_of(ends.begin(), ends.end(), [&](const Entry& e) { return e.index == unknown; })) continue;
    if (row[0].coeff != 1.0 || used[idx(unknown)]) return {};
    inner.push_back(unknown);
  }
  return inner;
}

bool ComplexStiffnesses::alone(std::size_t term, const std::vector<int>& inner, const Vector& damping,
                               const Vector& stiffness) const {
  const SparseMatrix& pattern = system_.pattern();
  const FrequencyTerm& its = system_.frequency_terms()[term];
  for (const double omega : {10.0, 1000.0}) {
    Complex given = 0.0;
    for (const int unknown : inner) {
      Complex own = 0.0, coupling = 0.0;
      std::size_t others = 0;
      for (int slot = pattern.outerIndexPtr()[unknown]; slot < pattern.outerIndexPtr()[unknown + 1]; ++slot) {
        const int row = pattern.innerIndexPtr()[slot];
        const Complex s(stiffness[slot] - omega * omega * system_.mass_values()[slot], omega * damping[slot]);
        if (row == unknown) own = s;
        if (row == unknown || s == 0.0) continue;
        const auto at =
            std::find_if(its.z.begin(), its.z.end(), [&](const Entry& e) { return e.index == row; });
        if (at == its.z.end()) return false;
        coupling = s / at->coeff;
        ++others;
      }
      if (others != its.z.size() || own == 0.0) return false;
      given -= coupling * coupling / own;
    }
    const Complex without = *its.stiffness->beyond_held(omega, {}),
                  with = its.stiffness->beyond_matrices(omega, {});
    if (!(std::abs(given - (without - with)) <= kSameChain * (std::abs(with) + std::abs(without))))
      return false;
  }
  return true;
}

Complex ComplexStiffnesses::beyond(std::size_t term, double omega, const CarriedLoad& load) const {
  const FrequencyStiffness& stiffness = *system_.frequency_terms()[term].stiffness;
  return term_held_[term] ? *stiffness.beyond_held(omega, load) : stiffness.beyond_matrices(omega, load);
}

void ComplexStiffnesses::add(double omega, const std::function<Complex(std::size_t)>& stiffness,
                             Vector& damping_values, Vector& stiffness_values) const {
  Complex k = 0.0;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (i == 0 || slot_terms_[i] != slot_terms_[i - 1]) k = stiffness(idx(slot_terms_[i]));
    stiffness_values[slots_[i]] += k.real() * slot_times_[i];
    damping_values[slots_[i]] += k.imag() / omega * slot_times_[i];
  }
}

}  // namespace drev
