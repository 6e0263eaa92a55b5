#pragma once
/// Default of a mandatory parameter: whoever forgets it reads "stiffness = NaN ..." from build().
#include <limits>

namespace drev {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

}  // namespace drev
