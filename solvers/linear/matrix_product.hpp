#pragma once
/// MatrixProduct: products with one constant matrix of a System, by its diagonals where a few of them hold
/// all that is not zero (chains, lumped inertias), else row by row.
#include <drev/core/system.hpp>

#include "solvers/linear/vector_kernels.hpp"

namespace drev {

class MatrixProduct {
 public:
  /// values: of a symmetric matrix on the pattern; both must outlive this.
  MatrixProduct(const SparseMatrix& pattern, const Vector& values);

  /// No entry that is not 0.
  bool zero() const { return !by_rows_ && bands_.empty(); }
  /// out = factor A x. out and x are different vectors.
  void multiply(double factor, const Vector& x, Vector& out) const { apply(factor, x, nullptr, out); }
  /// out = y + factor A x. All three are different vectors.
  void multiply_add(double factor, const Vector& x, const Vector& y, Vector& out) const {
    apply(factor, x, y.data(), out);
  }
  /// x' A x.
  double energy(const Vector& x) const;

 private:
  void apply(double factor, const Vector& x, const double* y, Vector& out) const;
  double row(const Vector& x, int i) const;

  const SparseMatrix& pattern_;
  const Vector& values_;
  bool by_rows_ = false;
  std::vector<Band> bands_;
};

}  // namespace drev
