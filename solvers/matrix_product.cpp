#include "solvers/matrix_product.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/step_kernels.hpp"

namespace drev {

namespace {
constexpr double kDiagonalFill = 3.0;  // diagonals for each entry that a row has, and one more
}

MatrixProduct::MatrixProduct(const SparseMatrix& pattern, const Vector& values)
    : pattern_(pattern), values_(values) {
  const int n = static_cast<int>(pattern.rows());
  const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
  std::map<int, std::size_t> place;
  const auto most = static_cast<std::size_t>(
      kDiagonalFill * (1.0 + static_cast<double>((values.array() != 0.0).count()) / n));
  for (int row = 0; row < n; ++row)
    for (int s = outer[row]; s < outer[row + 1]; ++s)
      if (values[s] != 0.0 && place.try_emplace(inner[s] - row, place.size()).second &&
          place.size() > most) {
        by_rows_ = true;
        return;
      }
  diagonals_.resize(place.size());
  for (const auto& [offset, k] : place)
    diagonals_[k] = {offset, std::vector<double>(at(n - std::abs(offset)), 0.0)};
  for (int row = 0; row < n; ++row)
    for (int s = outer[row]; s < outer[row + 1]; ++s)
      if (values[s] != 0.0) {
        const int offset = inner[s] - row;
        diagonals_[place.at(offset)].values[at(row + std::min(offset, 0))] = values[s];
      }
}

void MatrixProduct::add(double factor, const Vector& x, Vector& out) const {
  if (by_rows_) {
    const int *outer = pattern_.outerIndexPtr(), *inner = pattern_.innerIndexPtr();
    for (int row = 0; row < pattern_.rows(); ++row) {
      double sum = 0.0;
      for (int s = outer[row]; s < outer[row + 1]; ++s) sum += values_[s] * x[inner[s]];
      out[row] += factor * sum;
    }
    return;
  }
  for (const Diagonal& d : diagonals_) {
    const int first_row = std::max(-d.offset, 0), first_column = std::max(d.offset, 0);
    add_scaled(static_cast<int>(d.values.size()), factor, d.values.data(), x.data() + first_column,
               out.data() + first_row);
  }
}

}  // namespace drev
