#pragma once
/// Harmonic balance: the periodic motion z = Re sum_n Z_n exp(i n w t), n = 0..H, of period T = 2 pi/w.
///
///   (K + i n w C - (n w)^2 M) Z_n + F_n[B y + g - p] = 0
///
/// F_n: harmonic n of forces sampled at N = 4 H equidistant times of the period (alternating frequency/time
/// method: T. M. Cameron, J. H. Griffin, J. Appl. Mech. 56, 1989, doi:10.1115/1.3176036); harmonics of tables
/// have no sampling error (load_harmonics.hpp). The equations are solved by Newton's method, preconditioned
/// by the inverse S_n^-1 of the dynamic stiffness with every contact closed:
///
///   d + S^-1 F[(dK(t) + dC(t) d/dt) d] = -S^-1 R,     dK, dC: slopes at each time less the closed ones
///
/// d is found by matrix-free GMRES. Linear systems need one solve for each harmonic at which something acts; the others
/// are 0. The slopes leave out how a law follows the deviation of its phase node.
#include <drev/core/assembler.hpp>

#include <Eigen/Core>
#include <complex>
#include <string>

#include "solvers/linear/sparse_lu.hpp"
#include "solvers/periodic/load_harmonics.hpp"

namespace drev {

class HarmonicBalance {
 public:
  using Harmonics = Eigen::MatrixXcd;  ///< unknowns x (H + 1)
  using Samples = Eigen::MatrixXd;     ///< unknowns x N, at equidistant times from t = 0

  /// period: s, > 0.
  HarmonicBalance(const System& system, double period);

  struct Outcome {
    std::string reason;     ///< why there is no solution; empty: converged
    int iterations = 0;     ///< iterations of Newton's method
    double residual = 0.0;  ///< size of the next Newton step relative to the size of Z [-]
  };
  /// The start: every contact closed on the flank that the mean load presses on, loads evaluated without
  /// deviations.
  Outcome start(int harmonics, int samples, Harmonics& z);
  /// z: start in (of any number of harmonics up to H), solution out.
  Outcome solve(int harmonics, int samples, double tolerance, Harmonics& z);

  /// The derivative-th derivative of the motion in time.
  Samples motion(const Harmonics& z, int derivative, int samples) const;
  static Harmonics to_harmonics(const Samples& samples, int harmonics);
  /// Largest change of a force from t to t + T in the motion, relative to the largest force [-]. It is
  /// rounding where all loads have the period.
  double aperiodicity(const Harmonics& z, int samples);
  /// Size of a motion: square root of the time average of sum K_ii z_i^2, with contacts closed.
  double size(const Harmonics& z) const;

 private:
  struct Slope {  // an entry of the stiffness and damping matrices that may vary over the period
    int row = 0, column = 0, slot = 0;
  };
  struct Feedback {  // a load that follows the motion, and its node over the unknowns
    const LoadTerm* term;
    std::vector<Entry> row;
  };
  /// Whether no law and no load follows the motion: each harmonic then is a problem of its own.
  bool linear() const { return slopes_.empty() && feedback_.empty(); }
  double inner(const Harmonics& a, const Harmonics& b) const;
  /// p - B y - g in the motion, `later` periods after the first, with all loads or without those of loads_.
  Samples forces(const Samples& q, const Samples& v, double later, bool all_loads);
  Harmonics force_harmonics(const Harmonics& z, int samples);
  /// right -> S^-1 right. False: S is singular at harmonic singular_harmonic_.
  bool solve_stiffness(Harmonics& right);
  /// Sets out to -S^-1 R.
  bool correction(const Harmonics& z, int samples, Harmonics& out);
  void find_slopes(const Harmonics& z, int samples);
  bool apply(const Harmonics& d, int samples, Harmonics& out);
  bool direction(const Harmonics& right, int samples, Harmonics& d);
  std::string singular() const;

  const System& system_;
  Assembler assembler_;
  LoadHarmonics loads_;
  double w_;
  Vector closed_k_, closed_c_;
  Vector scale_;  // weights of Re and Im of each unknown in inner()
  Vector history_;
  SparseMatrix pattern_;  // pattern of S as a real matrix, with (Re, Im) of each unknown side by side
  SparseLu factor_;
  std::vector<Slope> slopes_;
  std::vector<Feedback> feedback_;
  Eigen::MatrixXd dk_, dc_;  // dK and dC at the N times: rows of slopes_, then of feedback_
  int singular_harmonic_ = 0;
};

}  // namespace drev
