#pragma once
/// Division of an edge into cells whose sizes grow from its ends.
#include <vector>

namespace drev {

/// Sizes of the cells at the two ends, in the unit of the length, and their growth.
struct Grading {
  double first = 0.0, last = 0.0;  ///< sizes of the cells at the ends, > 0
  double growth = 0.5;             ///< growth of the size per distance from an end [-], >= 0
  double largest = 0.0;            ///< largest size of any cell, > 0
};

/// Ends of the cells along an edge of a length > 0, as ascending fractions from 0 to 1. At a distance x from
/// the first end a cell has about the size h(x) = min(largest, first + growth x, last + growth (length - x));
/// all sizes are reduced by one factor so that the cells fill the edge.
std::vector<double> graded_division(double length, const Grading& grading);

}  // namespace drev
