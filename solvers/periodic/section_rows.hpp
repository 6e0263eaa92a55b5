#pragma once
/// A section of a sweep: torque or force of an element, or another channel that is linear in the motion, as
/// rows over the unknowns.
#include <drev/core/error.hpp>
#include <drev/core/system.hpp>

#include <string>
#include <vector>

namespace drev {

struct SectionRows {
  std::string name, unit, twist_unit;
  std::vector<Entry> stiffness, damping;  ///< y = stiffness z + damping z'; for a law with its contact closed
  std::vector<Entry> twist;               ///< twist of its element; empty: none
  std::vector<Entry> damper;              ///< part of y from the damper; heat is damper z' times twist'
  int frequency_term = -1;                ///< number of its complex stiffness in the system; -1: none
  bool contact = false;
  int law = -1;  ///< number of the law in System::scalars() whose force it is; -1: none
};

/// names: names of channels; empty: torque or force of every element that has one. Faults are added to
/// findings.
std::vector<SectionRows> find_section_rows(const System& system, const std::vector<std::string>& names,
                                           std::vector<Finding>& findings);

}  // namespace drev
