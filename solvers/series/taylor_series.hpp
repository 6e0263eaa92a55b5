#pragma once
/// TaylorSeries: the solution of a linear system over one step, in s = (t - t_0)/h:
///
///   M z'' + C z' + K z = P_0 + P_1 s + P_2 s^2 + ...,      z = sum Z_k s^k
///   (k+2)(k+1)/h^2 M Z_{k+2} = P_k - (k+1)/h C Z_{k+1} - K Z_k
///
/// K and C are those of the system with the tangents of the pieces that hold (set by the caller). Rows of
/// the series behind the unknowns are the system's loaded rows: forces and slopes there act through them.
/// One sparse product a degree, by diagonals where the pattern has few of them; M diagonal is a
/// scaling, else one solve with its factor. The series is carried until the next two terms are
/// below the tolerance, as deflections and as rates, by (|.|: the largest eigenvalue, or row sum if less)
///   |Z_{k+2}| <= h^2 |M^-1 K| |Z_k|/((k+1)(k+2)) + h |M^-1 C| |Z_{k+1}|/(k+2)
/// If that is not so by kMaxDegree, the step is shortened: Z_k r^k is the same solution over r h.
///
/// Rounding grows as exp(fastest rate h); the caller bounds the step by it. Source: D. Barton,
/// I. M. Willers, R. V. M. Zahar, The automatic solution of systems of ordinary differential
/// equations by the method of Taylor series, Computer J. 14, 1971, doi:10.1093/comjnl/14.3.243.
#include <drev/core/assembler.hpp>
#include <drev/core/lanes.hpp>

#include <algorithm>
#include <array>

#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

class TaylorSeries;

/// Forces whose coefficients follow from those of the motion, term by term (products of series), or from the very term
/// that they act on (dry friction).
class TermForces {
 public:
  /// False: they add nothing to this step.
  virtual bool active() const { return true; }
  /// A sweep (TaylorSeries::sweep) may leave them out: their tangents are in stiffness and damping.
  virtual bool sweeps() const { return false; }
  /// Up to this power of s they may have terms of their own.
  virtual int known_degree() const { return 0; }
  /// Adds what they make of term k: M^-1 f_{k-2} times factor = h^2/(k (k - 1)). Returns the largest of what they added,
  /// or infinity for as much as the whole term: what tells how far their own series is from its end.
  virtual double add(const TaylorSeries& series, int k, double factor, double* term) = 0;
  /// Raises `most`, by kind, to factor times the accelerations M^-1 f by what the terms of f up to s^(k-2) leave out of it at s = 1.
  virtual void note_left_out(const TaylorSeries& /*series*/, int /*k*/, double /*factor*/,
                             std::array<double, 2>& /*most*/) const {}

 protected:
  ~TermForces() = default;
};

class TaylorSeries {
 public:
  static constexpr int kMaxDegree = 32;

  /// Throws SolverError if M cannot be factored.
  explicit TaylorSeries(const System& system);

  /// K and C back to the system's own, the right side to zero; then add what the pieces add.
  void reset();
  void add_stiffness(int slot, double value) { k_.add(position_[idx(slot)], value); }
  /// The same on the diagonal of a row.
  void add_row_stiffness(int row, double value) {
    if (row >= n_)
      row_slopes_[row - n_] += value;
    else if (k_main_ != nullptr)
      main_diagonal()[row] += value;
    else
      add_stiffness(system_.diagonal_slots()[idx(row)], value);
  }
  /// The same of `count` rows, factor times a value each.
  void add_row_stiffness(int count, const int* rows, const double* values, double factor) {
    if (k_main_ == nullptr || row_slopes_.size() > 0) {
      for (int i = 0; i < count; ++i) add_row_stiffness(rows[i], factor * values[i]);
      return;
    }
    double* main = main_diagonal();
    for (int i = 0; i < count; ++i) main[rows[i]] += factor * values[i];
  }
  /// Subtracts slopes of loads from the diagonal of each row, and notes them (widen()).
  void add_row_slopes(const double* slope);
  /// Adds k b b^T with the row b of a term; the same of a damper, and takes back the one that was added last.
  void add_spring(const ScalarTerm& term, double k);
  void add_damper(const ScalarTerm& term, double c);
  void take_damper();
  /// Adds the slope of a load by the speed of an unknown's row, which no damper loses.
  void add_load_damping(int row, double value) {
    c_.add(position_[idx(system_.diagonal_slots()[idx(row)])], value);
    damped_ = true;
    load_damping_.push_back({row, value});
  }
  /// Takes back what was added last.
  void take_load_damping() {
    c_.add(position_[idx(system_.diagonal_slots()[idx(load_damping_.back().index)])],
           -load_damping_.back().coeff);
    load_damping_.pop_back();
  }
  /// Notes tangents added to a row that bound_rates() did not see, |k| [N m/rad or N/m] and |c|.
  void widen(int row, double k, double c);
  /// The same of a damping along any row, as a rate c/m [1/s].
  void widen_damping(double rate) { c_more_ += rate; }
  /// Adds forces that act on every term, behind those added before. Owned by the caller.
  void act_through(TermForces* forces) { term_forces_.push_back(forces); }
  /// Estimate from above of the fastest rate |lambda| with those [1/s]. Along a mode x, of mass x* M x = 1, lambda^2 + lambda c + k =
  /// 0 with c = x* C x, k = x* K x: a pair has |lambda| = sqrt(k); a real root at most (|c| + sqrt(c^2 - 4 k))/2, which is |c| unless k < 0,
  /// as slopes of loads may make it (F. Tisseur, K. Meerbergen, The quadratic eigenvalue problem, SIAM Rev. 43, 2001).
  double rate() const;
  /// P_k [N m or N] by rows. reset() sets P_0 ... P_2 to zero and the degree of the right side to 2; who
  /// sets a higher one, up to kProjectionDegree, has written all of those above.
  double* right_side(int k) { return p_.data() + idx(k * stride_); }
  void set_right_degree(int degree) { right_degree_ = degree; }

  /// Takes the values that stand now as the largest there will be: bounds |M^-1 K| and |M^-1 C| by
  /// them and returns an estimate from above of the fastest rate |lambda| [1/s] (power iteration).
  double bound_rates();

  /// Takes over the bounds and the largest motion so far from a series of the same system.
  void scale_as(const TaylorSeries& other);
  /// Expands from (z, v) over h [s]; returns the step that it holds for, <= h; 0 if the terms
  /// overflow. tolerance: relative to the largest deflection and speed noted so far.
  double expand(const Vector& z, const Vector& v, double h, double tolerance);

  /// Of forces f_i on rows, W_j = int (e - s)^j/j! f_i ds at values[j step + i]; zeros behind the last one in whole lanes.
  struct RowMoments {
    int count = 0;
    const int* rows = nullptr;
    const double* values = nullptr;
    int step = 0;
    bool own_rows = false;  ///< no two on the same row
  };
  /// The motion y that forces f on the unknowns, on top of the right side, add up to s = e, by one backward
  /// sweep: (y, y') = sum_j A^j (0, h^2 M^-1 W_j), W_j = int (e - s)^j/j! f ds, j <= degree,
  /// A (y, u) = (u, -h^2 M^-1 K y - h M^-1 C u), with the tangents that stand now.
  /// Only where sweeps() holds. Source: variation of constants, with exp(A (e - s)) as its Taylor series.
  void sweep(const RowMoments& moments, int degree);
  /// The same for forces on any rows, W_degree ... W_0 in a column each, which are zero then; all parts of swept() are known.
  void sweep(double* moments, int degree);
  /// Adds moments to such columns.
  void add_to_columns(const RowMoments& moments, int degree, double* columns) const;
  bool sweeps() const;
  static constexpr int kMostSwept = 28;  ///< largest degree of a sweep
  /// Results of sweep(): y' by s (part = -1), y (0), and int (e - s)^(k-1)/(k-1)! y ds (part = k, up to kSweptParts - 1, or to the
  /// degree less 2).
  static constexpr int kSweptParts = 8;
  const double* swept(int part) const {
    return swept_.data() + idx(pad_ + (swept_degree_ + 1 - part) * stride_);
  }

  /// y and y' along a row, swept up to s, at the nodes of Gauss's rule over [0, s]: y' as its first Legendre polynomials.
  void swept_at_nodes(const std::vector<Entry>& row, double s, NodeValues& out) const;

  /// Loss up to s in the system's own dampers, and in those that add_damper() added; swept_too: with the motion swept up to there
  /// [J].
  double loss(double s, bool swept_too, bool of_added);
  /// What losses in a step may leave out of the series', relative to one by the largest rate so far.
  void set_loss_accuracy(double part) { left_of_loss_ = part; }

  long products() const { return products_; }  ///< with the matrices, one a degree
  int degree() const { return degree_; }
  /// The least number of terms of the step's series behind which all others add up to no more than `part` of the largest motion.
  int terms_within(double part) const;
  double step() const { return h_; }
  int size() const { return n_; }
  /// Rows of right_side() and of the coefficients, with padding (zeros) behind the size() of them.
  int stride() const { return stride_; }
  static int stride(const System& system) { return whole_lanes(system.size() + system.loaded_rows()); }
  const double* coefficients(int k) const { return z_.data() + idx(pad_ + k * stride_); }
  double coefficient(int k, int row) const { return coefficients(k)[row]; }
  /// Finds at once what evaluate(), work() and loss() read at s, where all of them are asked for.
  void sum_up(double s) { sums(s); }
  /// z and v at s; and what was swept up to s on top of them, at once or later.
  void evaluate(double s, Vector& z, Vector& v, bool with_swept = false) const;
  void add_swept(Vector& z, Vector& v) const;
  /// How far each row comes over the step; bounds of what its terms add up to and, stride() behind them, its terms' slopes by
  /// s from the second term on.
  void ranges(double* end, double* size);
  /// Bound of the distance of each unknown from the cubic through its values and rates at 0 and s (cubic_peak.hpp), and
  /// stride() behind it the same of its rate.
  void beyond_cubic(double s, double* out);
  /// int_0^s (sum P_k u^k) . z' du with columns P_k at p + k stride(), k <= degree.
  double work(const double* p, int degree, double s);
  /// z, and v where it is not null, at the nodes of Gauss's rule: rows of node q at q stride().
  void at_nodes(double* z, double* v) const { at_places(GaussRule::kNodes, gauss_rule().s.data(), z, v); }
  /// The same at n places s.
  void at_places(int n, const double* s, double* z, double* v) const;
  /// out = M^-1 rhs.
  void solve_mass(const Vector& rhs, Vector& out);

  /// Largest deflection and speed [s^-1 of it] so far and in the terms of this step, of rotational and of
  /// translational unknowns (kind 0 and 1, where there are both).
  using Norm = std::array<double, 2>;
  const Norm& z_scale() const { return z_step_scale_; }
  const Norm& v_scale() const { return v_step_scale_; }
  /// The same with values at Gauss's nodes, as at_nodes() gives them, in place of terms: those of a force that no polynomial holds
  /// are far larger than what they add up to.
  std::array<Norm, 2> scales_at_nodes(const double* z, const double* v) const;
  int kind(int row) const { return kinds_.empty() ? 0 : kinds_[idx(row)]; }
  /// Upper estimate of the acceleration of a row by a force on it [1/(kg m^2) or 1/kg].
  double mobility(int row) const {
    if (row >= n_) return row_mobility_[row - n_];
    return diagonal_mass_ ? inverse_mass_[idx(row)] : inverse_mass_sum_[row];
  }
  /// |k| between two unknowns over the first one's mass [1/s^2]; and a bound of all, as rate().
  double coupling(int row, int other) const;
  double largest_coupling() const { return coupling_ + k_more_; }
  /// Calls each(other, |k|) for every unknown in a row of the stiffness matrix, its own included.
  template <class Each>
  void for_row(int row, const Each& each) const {
    const int *outer = system_.pattern().outerIndexPtr(), *inner = system_.pattern().innerIndexPtr();
    for (int s = outer[row]; s < outer[row + 1]; ++s) each(inner[s], std::abs(k_.now[position_[idx(s)]]));
  }
  /// Whether some third one is coupled with both.
  bool share_neighbour(int row, int other) const;
  /// The same of the unknown that a force on a row moves most.
  double reach(int row) const { return row < n_ ? mobility(row) : row_reach_[row - n_]; }

 private:
  struct Diagonal {
    int offset;
    std::size_t values;
  };
  /// The values of a matrix: those that stand now, the system's own, and those for the recursion over a step (SeriesRecursion).
  struct Matrix {
    LaneVector now, base, step;
    std::vector<std::size_t> changed;   // where `now` may differ from `base`
    std::vector<std::size_t> unscaled;  // where `step` may differ from `now`, scaled
    void add(std::size_t at, double value) {
      now[at] += value;
      changed.push_back(at);
      unscaled.push_back(at);
    }
    void reset() {
      for (const std::size_t at : changed) now[at] = base[at];
      unscaled.insert(unscaled.end(), changed.begin(), changed.end());
      changed.clear();
    }
  };
  /// K's main diagonal, to be changed: it is reset and scaled as a whole.
  double* main_diagonal() {
    main_unscaled_ = true;
    return k_main_;
  }
  template <class Add>
  void for_slots(const ScalarTerm& term, double value, const Add& add);
  void find_storage();
  void find_views(bool far);
  void subtract_product(const LaneVector& values, bool main_only, const double* x, double factor,
                        double* out) const;
  double largest_eigenvalue(const LaneVector& values);
  /// Whether terms come from the kernel; and many in one call of it.
  bool by_kernel() const { return !diagonals_.empty() && diagonal_mass_; }
  bool by_diagonals() const { return by_kernel() && row_slopes_.size() == 0 && kinds_.empty(); }
  using Chain = std::array<const double*, 3>;
  Chain chain_of(const LaneVector& values) const;
  void scale_step();
  SeriesRecursion recursion();
  SeriesRecursion sweep_recursion(int degree);
  void product_term(const SeriesRecursion& recursion, int k);
  void next_terms(int first, int last);
  Norm next_term(int k);
  void find_rows();
  /// Sets the loaded rows of a column from its unknowns.
  void rows_of(double* column) const {
    const Eigen::Index m = row_slopes_.size();
    if (m > 0)
      Eigen::Map<Vector>(column + n_, m).noalias() =
          system_.rows().topRows(m) * Eigen::Map<const Vector>(column, n_);
  }
  void add_row_forces(const double* p, const double* x_0);
  /// The degree up to which terms count in energies.
  int energy_degree() const;
  void note_terms(int from, int to, double most, Norm& z_scale, Norm& v_scale) const;
  int loss_terms() const;
  bool added_damping() const {
    return std::any_of(dampers_.begin(), dampers_.end(), [](const Damper& d) { return d.c != 0.0; });
  }
  const double* sums(double s);
  void find_ends();
  std::size_t kinds() const { return kinds_.empty() ? 1 : 2; }  // of unknowns there are: entries of a Norm
  void sum_sizes(int first, int count, const double* weight, const Norm& tail, const Norm& other_tail,
                 double* out) const;
  bool add_term_forces(int k, double factor, double* term);
  Norm left_out(int k) const;
  void note_scale(const Vector& z, const Vector& v);
  Norm norm(const double* x) const;

  const System& system_;
  std::vector<TermForces*> term_forces_;
  int n_, stride_ = 0, pad_ = 0;
  Matrix k_, c_;
  LaneVector inverse_mass_, mobility_step_;      // mobility_step_: SeriesRecursion's
  double scaled_h_ = 0.0;                        // step that matrices are scaled for [s]; 0: none
  bool main_unscaled_ = false;                   // but for K's main diagonal
  std::vector<std::size_t> position_;            // of a slot of the pattern in K and C
  std::vector<Diagonal> diagonals_;              // padded to stride_; empty: rows of the pattern
  int main_ = -1;                                // which diagonal is the main one
  double* k_main_ = nullptr;                     // that of K now
  std::vector<DiagonalView> k_views_, c_views_;  // of each block of lanes
  std::vector<int> block_begin_;
  bool single_views_ = false;    // BlockDiagonals::single
  Chain k_chain_{}, c_chain_{};  // where nearly all of them are the main one and its neighbours: these
  bool undamped_ = false, base_main_damping_ = false;  // properties of the system's own C
  bool damped_ = false, main_damping_ = false, diagonal_mass_ = false;
  double k_norm_ = 0.0, c_norm_ = 0.0, k_more_ = 0.0, c_more_ = 0.0, coupling_ = 0.0;
  SparseCholesky mass_;
  Vector inverse_mass_sum_;  // of the sizes in each row of M^-1, where M is not diagonal
  LaneVector swept_;         // columns of the sweep behind two of zeros
  LaneVector swept_forces_;  // zeros between sweeps
  std::vector<std::int64_t, Eigen::aligned_allocator<std::int64_t>> packed_from_;
  int swept_degree_ = 0;
  LaneVector step_sums_, part_weights_, swept_moments_;  // see series_sums.cpp
  std::vector<Entry> load_damping_;                      // by row, within c_: for take_load_damping()
  struct Damper {
    const ScalarTerm* term;
    double c;
  };
  std::vector<Damper> dampers_;  // beside the system's own, within c_
  int loss_terms_ = 0;           // moments in step_sums_
  double left_of_loss_ = 1e-16;
  double sums_at_ = -1.0;    // s of step_sums_; -1: none of this step
  bool ends_known_ = false;  // their first columns are those of this step's end
  LaneVector p_, z_, zeros_;
  // Data of the system's loaded rows.
  Vector row_slopes_, row_forces_, row_mobility_, row_reach_;
  LaneVector with_rows_;
  mutable LaneVector values_;  // room for evaluate()
  Vector solve_in_, solve_out_;
  // Sizes of the terms from the second on, and of what forces that act on every term added to them.
  std::array<Norm, kMaxDegree + 1> sizes_{}, added_{};
  std::vector<int> kinds_;  // kinds of the unknowns, if the system has both
  Norm z_scale_{}, v_scale_{}, z_step_scale_{}, v_step_scale_{};
  int degree_ = 0, right_degree_ = 2;
  double h_ = 0.0, energy_part_ = 0.0;
  long products_ = 0;
};

}  // namespace drev
