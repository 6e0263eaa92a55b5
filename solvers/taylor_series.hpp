#pragma once
/// TaylorSeries: the solution of a linear system over one step, in s = (t - t_0)/h:
///
///   M z'' + C z' + K z = P_0 + P_1 s + P_2 s^2 + sum F_k s^k,      z = sum Z_k s^k
///   (k+2)(k+1)/h^2 M Z_{k+2} = P_k + F_k - (k+1)/h C Z_{k+1} - K Z_k
///
/// K and C are those of the system with the tangents of the pieces that hold (set by the caller).
/// One sparse product a degree, by diagonals where the pattern has few of them; M diagonal is a
/// scaling, else one solve with its factor. The series is carried until the next two terms are
/// below the tolerance, as deflections and as rates, by the bound (norms: largest
/// row sums)
///   |Z_{k+2}| <= h^2 |M^-1 K| |Z_k|/((k+1)(k+2)) + h |M^-1 C| |Z_{k+1}|/(k+2)
/// or, where a load has a series of its own, until the last two are. If that is not so by
/// kMaxDegree, the step is shortened: Z_k r^k is the same solution over r h.
///
/// Rounding grows as exp(fastest rate h); the caller bounds the step by it. Source: D. Barton,
/// I. M. Willers, R. V. M. Zahar, The automatic solution of systems of ordinary differential
/// equations by the method of Taylor series, Computer J. 14, 1971, doi:10.1093/comjnl/14.3.243.
#include <array>

#include "core/assembler.hpp"
#include "solvers/sparse_cholesky.hpp"

namespace drev {

/// Adds what depends on the solution itself, degree by degree.
class SeriesSource {
 public:
  virtual ~SeriesSource() = default;
  /// rhs += F_k, from the coefficients 0 ... k of z (column k at z + k n).
  virtual void add(int k, const double* z, double* rhs) = 0;
};

class TaylorSeries {
 public:
  static constexpr int kMaxDegree = 32;

  /// Throws SolverError if M cannot be factored.
  explicit TaylorSeries(const System& system);

  /// K and C back to the system's own; then add what the pieces add.
  void reset();
  void add_stiffness(int slot, double value) { k_[position_[at(slot)]] += value; }
  void add_damping(int slot, double value);
  /// P_0, P_1, P_2 [N m or N]: polynomial right side over the step.
  std::array<Vector, 3>& right_side() { return p_; }

  /// Takes the values that stand now as the largest there will be: bounds |M^-1 K| and |M^-1 C| by
  /// them and returns an upper estimate of the fastest rate |lambda| [1/s] (Gershgorin, scaled by
  /// the inertias).
  double bound_rates();

  /// Expands from (z, v) over h [s]; returns the step that it holds for, <= h; 0 if the terms
  /// overflow. tolerance: relative.
  double expand(const Vector& z, const Vector& v, double h, double tolerance, SeriesSource* source);
  /// Deflections and speeds that the tolerance is relative to grow with these.
  void note_scale(const Vector& z, const Vector& v);

  int degree() const { return degree_; }
  double step() const { return h_; }
  int size() const { return n_; }
  const double* coefficients() const { return z_.data(); }  ///< column k at k * size()
  /// z and v at s.
  void evaluate(double s, Vector& z, Vector& v) const;
  /// int z'^T C z' dt from 0 to s of the step with the system's own C: what linear dampers took
  /// [J].
  double dissipated(double s);
  /// out = M^-1 rhs.
  void solve_mass(const Vector& rhs, Vector& out);

 private:
  struct Diagonal {
    int offset, begin, end;
    std::size_t values;  // of row `begin`
  };
  using Norm = std::array<double, 2>;  // rotational, translational
  void find_storage();
  void product(const std::vector<double>& values, bool main_only, const double* x, double factor,
               double* out) const;
  Norm norm(const double* x) const;

  const System& system_;
  int n_;
  std::vector<double> k_, c_, k_base_, c_base_, inverse_mass_;
  std::vector<std::size_t> position_;  // of a slot of the pattern in k_, c_
  std::vector<Diagonal> diagonals_;    // empty: rows of the pattern
  int main_ = -1;                      // which diagonal is the main one
  bool three_in_one_ = false;          // it and its two neighbours are there: one loop for them
  bool undamped_ = false, base_main_damping_ = false;  // of the system's own C
  bool damped_ = false, main_damping_ = false, diagonal_mass_ = false;
  double k_norm_ = 0.0, c_norm_ = 0.0;
  SparseCholesky mass_;
  double mass_norm_ = 0.0;  // of M^-1, largest row sum, where M is not diagonal
  std::array<Vector, 3> p_;
  std::vector<double> z_;
  Vector rhs_, solved_;
  Eigen::MatrixXd rates_, forces_;
  std::vector<int> translational_;  // unknowns, if the system has both kinds
  Norm z_scale_{}, v_scale_{};
  int degree_ = 0;
  double h_ = 0.0;
};

}  // namespace drev
