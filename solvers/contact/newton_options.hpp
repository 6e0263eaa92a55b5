#pragma once
/// Options of Newton's method: on the contact forces (contact_newton.hpp), and with the sparse tangent
/// (sparse_newton.hpp).

namespace drev {

struct ContactNewtonOptions {
  int max_iterations = 50;
  /// |lambda - y| below tolerance * force_scale [-].
  double tolerance = 1e-12;
  bool line_search = true;  ///< false: plain Newton, to show that it cycles
  /// Start from the forces that the laws' slopes in the solve() before lead to: exact as long as no law
  /// leaves its piece, and then one look at the laws is enough.
  bool expects = true;
};

struct SparseNewtonOptions {
  int max_iterations = 60;
  double tolerance = 1e-11;  ///< |R| relative to the largest force in it
  bool line_search = true;
};

}  // namespace drev
