#pragma once
/// Division of an edge into cells whose sizes grow from its ends.
#include <vector>

namespace drev {

/// Sizes at the two ends and how they grow; all in the unit of the length, growth without unit.
struct Grading {
  double first = 0.0, last = 0.0;  ///< > 0: sizes of the cells at the ends
  double growth = 0.5;             ///< >= 0: change of the size over the distance from an end
  double largest = 0.0;            ///< > 0: of any cell
};

/// Ends of the cells along an edge of a length > 0 as fractions, from 0 to 1, ascending. At a distance x from the
/// first end a cell has about h(x) = min(largest, first + growth x, last + growth (length - x)); all are shrunk by
/// one factor so that they fill the edge.
std::vector<double> graded_division(double length, const Grading& grading);

}  // namespace drev
