#include "solvers/fields/graded_division.hpp"

#include <algorithm>

namespace drev {

std::vector<double> graded_division(double length, const Grading& grading) {
  const auto size = [&](double x) {
    return std::min({grading.largest, grading.first + grading.growth * x,
                     grading.last + grading.growth * std::max(length - x, 0.0)});
  };
  std::vector<double> ends{0.0};
  // A remainder of less than a quarter of a cell is distributed over the other cells.
  for (double x = 0.0; length - x > 0.25 * size(x);) {
    x += size(x + 0.5 * size(x));
    ends.push_back(x);
  }
  if (ends.size() == 1) ends.push_back(length);
  const double all = ends.back();
  for (double& end : ends) end /= all;
  return ends;
}

}  // namespace drev
