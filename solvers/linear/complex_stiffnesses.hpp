#pragma once
/// The elements with a complex stiffness k* (frequency_stiffness.hpp) in the matrices of the frequency domain:
///
///   K(w) = K + sum_t Re k_t b_t b_t',   C(w) = C + sum_t Im k_t / w  b_t b_t'
///
/// k_t is k* less what the matrices give, with the internal nodes at rest that only the chain of the element in time needs.
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/system.hpp>

#include <complex>
#include <functional>
#include <vector>

namespace drev {

class ComplexStiffnesses {
 public:
  /// used: the unknowns, one flag each, that something else than a matrix, law or load looks at, and that stay therefore; empty: none.
  explicit ComplexStiffnesses(const System& system, std::vector<bool> used = {});

  std::size_t count() const { return term_held_.size(); }
  /// The unknowns at rest, one flag each: internal nodes of elements that know k* without them, if no other element acts on these.
  const std::vector<bool>& held() const { return held_; }
  /// Whether a term is constant over frequency, under any one load.
  bool constant(std::size_t term) const { return term_constant_[term]; }
  /// k_t at omega > 0 [rad/s] under a load [N m/rad].
  std::complex<double> beyond(std::size_t term, double omega, const CarriedLoad& load) const;
  /// Adds k_t = stiffness(t) at omega > 0 [rad/s]; values on System::pattern().
  void add(double omega, const std::function<std::complex<double>(std::size_t term)>& stiffness,
           Vector& damping_values, Vector& stiffness_values) const;
  /// The places of the pattern to which terms contribute; for each its term, and the factor of k_t.
  const std::vector<int>& slots() const { return slots_; }
  const std::vector<int>& slot_terms() const { return slot_terms_; }
  const std::vector<double>& slot_times() const { return slot_times_; }

 private:
  void find_slots();
  /// The internal unknowns of a term's element that its chain alone needs; empty: there are none, or not all can be at rest.
  std::vector<int> inner_of(std::size_t term, const std::vector<bool>& used) const;
  /// Whether these unknowns, eliminated, give the part of the matrices that the element states, so that no other element acts on them.
  bool alone(std::size_t term, const std::vector<int>& inner, const Vector& damping,
             const Vector& stiffness) const;

  const System& system_;
  std::vector<bool> held_, term_held_, term_constant_;
  std::vector<int> slots_, slot_terms_;
  std::vector<double> slot_times_;
};

}  // namespace drev
