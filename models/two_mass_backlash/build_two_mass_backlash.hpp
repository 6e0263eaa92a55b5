#pragma once
/// The source's benchmark against FEDEM (S. L. Sunde, NTNU, 2015, section 4.4.1, figure 4.7):
///
///   ground --(k_1, half gap b_1)-- mass_1 --(k_2, half gap b_2)-- mass_2 <- F(t)
///
/// no damping, at rest in mid gap at t = 0. F rises linearly to its full value at 1 s, holds to 2 s and is
/// released at once. The size of F is not printed in the source; 100 N is drev's choice.
/// The published cases: zero backlash k 2000, 2000; A2 with half gaps 0.05, 0.05; B (the default) with k
/// 2000, 1000 and half gaps 0.05, 0.03.
#include <drev/models/model_case.hpp>

namespace drev {

ModelCase build_two_mass_backlash(Parameters parameters);
const ModelEntry& two_mass_backlash_entry();

}  // namespace drev
