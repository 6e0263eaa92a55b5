#pragma once
/// MatrixProduct: products with one constant matrix of a System, by its diagonals where a few of them hold
/// all that is not zero (chains, lumped inertias), else row by row.
#include "core/system.hpp"

namespace drev {

class MatrixProduct {
 public:
  /// values: of a symmetric matrix on the pattern; both must outlive this.
  MatrixProduct(const SparseMatrix& pattern, const Vector& values);

  /// out += factor A x. out and x are different vectors.
  void add(double factor, const Vector& x, Vector& out) const;

 private:
  struct Diagonal {
    int offset;                  // column less row
    std::vector<double> values;  // of its rows, from the first that it has
  };
  const SparseMatrix& pattern_;
  const Vector& values_;
  bool by_rows_ = false;
  std::vector<Diagonal> diagonals_;
};

}  // namespace drev
