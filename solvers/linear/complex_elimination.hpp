#pragma once
/// Complex symmetric elimination of a dynamic stiffness whose pattern stays the same:
///
///   S(s) = K + s C + s^2 M = P' L D L' P,   S x = b,   s = i w for a steady state at the circular frequency w
///
/// P (minimum degree) and the places of all updates are found once; a factorisation is then one pass over
/// them, without search. Along a tree or chain of shafts nothing fills in, and its cost grows with the number
/// of nodes.
///
/// No pivots are sought. Where one is lost to cancellation (below kLostPivot of the terms that it was made of:
/// an undamped branch at its own antiresonance) S is factored once more by a sparse LU with pivoting.
///
/// Accuracy: backward error of a few eps times the growth, which kLostPivot limits to 1e5.
/// Source: I. S. Duff, A. M. Erisman, J. K. Reid, Direct Methods for Sparse Matrices, 2nd ed., Oxford, 2017,
/// chapters 5 and 11 (minimum degree on trees, symbolic phase).
#include <drev/core/system.hpp>

#include <complex>
#include <memory>
#include <vector>

namespace drev {

class ComplexElimination {
 public:
  static constexpr double kLostPivot = 1e-5;

  /// pattern: square, compressed, symmetric in structure. held: unknowns that are 0, by their number; their equations
  /// are left out, and their places of a right side must be 0.
  explicit ComplexElimination(const SparseMatrix& pattern, const std::vector<bool>& held = {});
  ~ComplexElimination();
  ComplexElimination(ComplexElimination&&) noexcept;

  /// m, c, k: values of symmetric matrices on the pattern. False: singular, or not finite.
  bool factorize(const Vector& m, const Vector& c, const Vector& k, std::complex<double> s);
  /// b -> x, size() entries in place. After a factorisation that succeeded.
  void solve(std::complex<double>* x);
  /// The last factorisation sought pivots, since one was lost.
  bool pivoted() const { return use_pivoted_; }
  int size() const { return n_; }  ///< unknowns that are not held

 private:
  friend class LaneElimination;
  using Complex = std::complex<double>;
  struct Pivoted;
  bool factorize_pivoted(const Vector& m, const Vector& c, const Vector& k, Complex s);

  int n_ = 0;
  std::vector<bool> held_;          // whether each unknown of the pattern is held
  std::vector<int> order_;          // order_[j]: unknown eliminated as number j
  std::vector<int> diagonal_slot_;  // slot of each diagonal entry in the pattern
  std::vector<int> begin_;          // of column j of L in row_; n_ + 1
  std::vector<int> row_, slot_;     // of each entry of L: its number, its place in the pattern or -1
  std::vector<int> target_;  // of each update, in the order in which they are made: < 0: diagonal -1 - j
  std::vector<Complex> d_, l_, w_, x_;  // 1 / D, L, column before division, work space
  SparseMatrix pattern_;
  std::unique_ptr<Pivoted> pivoted_;
  bool use_pivoted_ = false;
};

}  // namespace drev
