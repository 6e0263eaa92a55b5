#pragma once
/// The sections of a sweep: torques and forces of elements, and other channels that are linear in the motion, as
/// rows over the unknowns.
#include <drev/core/error.hpp>
#include <drev/core/system.hpp>

#include <string>
#include <vector>

namespace drev {

struct SectionRows {
  std::string name, unit, twist_unit;
  std::vector<Entry> stiffness, damping;  ///< y = stiffness z + damping z'; of a law: contact closed
  std::vector<Entry> twist;               ///< its element's twist; empty: none
  std::vector<Entry> damper;              ///< the damper's part of y; heat is damper z' times twist'
  int frequency_term = -1;                ///< of the system: its element's complex stiffness
  bool contact = false;
  int law = -1;  ///< of System::scalars(), whose force it is
};

/// names: channels; empty: torque or force of every element that has one. What is wrong goes to findings.
std::vector<SectionRows> find_section_rows(const System& system, const std::vector<std::string>& names,
                                           std::vector<Finding>& findings);

}  // namespace drev
