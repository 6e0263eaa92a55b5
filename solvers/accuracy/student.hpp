#pragma once
/// Student's t: the factor that makes an interval of a mean from few values.
#include <array>
#include <cstddef>

namespace drev {

/// 97.5 % quantile of Student's t with n degrees of freedom, n >= 1 (infinity: the normal distribution's): a mean of n + 1 independent
/// normal values lies within it times s/sqrt(n + 1) of the true one with 95 % confidence. By table up to 20, beyond by the first terms
/// of Cornish-Fisher's expansion (Abramowitz and Stegun, 1964, 26.7.5); right to 1e-3.
inline double student_95(double n) {
  constexpr std::array<double, 20> table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365,
                                         2.306,  2.262, 2.228, 2.201, 2.179, 2.160, 2.145,
                                         2.131,  2.120, 2.110, 2.101, 2.093, 2.086};
  if (n <= 20.0) return table[static_cast<std::size_t>(n) - 1];
  return 1.959963984540054 + 2.3722 / n + 2.8225 / (n * n);
}

}  // namespace drev
