#include "solvers/linear/matrix_product.hpp"

#include <set>

#include "solvers/linear/huge_pages.hpp"

namespace drev {

namespace {
constexpr double kDiagonalFill = 3.0;  // diagonals for each entry that a row has, and one more
}

MatrixProduct::MatrixProduct(const SparseMatrix& pattern, const Vector& values)
    : pattern_(pattern), values_(values) {
  const int n = static_cast<int>(pattern.rows());
  const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
  std::set<int> offsets;
  const auto most = static_cast<std::size_t>(
      kDiagonalFill * (1.0 + static_cast<double>((values.array() != 0.0).count()) / n));
  for (int row = 0; row < n; ++row)
    for (int s = outer[row]; s < outer[row + 1]; ++s)
      if (values[s] != 0.0 && inner[s] >= row && offsets.insert(inner[s] - row).second &&
          2 * offsets.size() > most + 1) {
        by_rows_ = true;
        return;
      }
  for (const int offset : offsets) set_zeros(bands_.emplace_back(Band{offset, {}}).values, n - offset);
  for (int row = 0; row < n; ++row)
    for (int s = outer[row]; s < outer[row + 1]; ++s)
      if (values[s] != 0.0)
        for (Band& band : bands_)
          if (band.offset == inner[s] - row) band.values[row] = values[s];
}

double MatrixProduct::row(const Vector& x, int i) const {
  double sum = 0.0;
  add_row_product(pattern_.outerIndexPtr(), pattern_.innerIndexPtr(), values_.data(), x.data(), i, sum);
  return sum;
}

void MatrixProduct::apply(double factor, const Vector& x, const double* y, Vector& out) const {
  const int n = static_cast<int>(x.size());
  out.resize(n);
  if (by_rows_)
    for (int i = 0; i < n; ++i) out[i] = (y ? y[i] : 0.0) + factor * row(x, i);
  else
    band_product(n, bands_, factor, x.data(), y, out.data());
}

double MatrixProduct::energy(const Vector& x) const {
  const int n = static_cast<int>(x.size());
  if (!by_rows_) return band_energy(n, bands_, x.data());
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += x[i] * row(x, i);
  return sum;
}

}  // namespace drev
