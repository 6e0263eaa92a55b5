#include "solvers/lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "core/lanes.hpp"

namespace drev {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kBetweenChecks = 3;
constexpr double kApart = 1e-5;  // of the largest: eigenvalues of T whose vectors come out orthogonal
// Rows of a strip: two vectors that stay in the cache while the basis streams by, or all of the basis.
constexpr int kLongStrip = 4096, kShortStrip = 512;

/// Eigenvalues of the tridiagonal matrix (d, e), into d, by implicit QL; the columns of z, one a row of the
/// matrix, are rotated along. e is used up. False where it does not converge.
bool tridiagonal_eigen(Vector& d, Vector& e, Eigen::MatrixXd& z) {
  const Eigen::Index n = d.size();
  for (Eigen::Index l = 0; l < n; ++l)
    for (int sweep = 0;; ++sweep) {
      Eigen::Index m = l;
      while (m + 1 < n && std::abs(e[m]) > kEpsilon * (std::abs(d[m]) + std::abs(d[m + 1]))) ++m;
      if (m == l) break;
      if (sweep == 50) return false;
      double g = (d[l + 1] - d[l]) / (2.0 * e[l]);
      g = d[m] - d[l] + e[l] / (g + std::copysign(std::sqrt(g * g + 1.0), g));
      double s = 1.0, c = 1.0, p = 0.0;
      Eigen::Index i = m - 1;
      for (; i >= l; --i) {
        const double f = s * e[i], b = c * e[i];
        const double r = std::sqrt(f * f + g * g);
        e[i + 1] = r;
        if (r == 0.0) {
          d[i + 1] -= p;
          e[m] = 0.0;
          break;
        }
        s = f / r;
        c = g / r;
        g = d[i + 1] - p;
        const double q = (d[i] - g) * s + 2.0 * c * b;
        p = s * q;
        d[i + 1] = g + p;
        g = c * q - b;
        double *left = z.data() + i * z.rows(), *right = left + z.rows();
        for (Eigen::Index k = 0; k < z.rows(); ++k) {
          const double old = right[k];
          right[k] = s * left[k] + c * old;
          left[k] = c * left[k] - s * old;
        }
      }
      if (i >= l) continue;
      d[l] -= p;
      e[l] = g;
      e[m] = 0.0;
    }
  return true;
}

/// The eigenvector of the tridiagonal matrix (d, e) to theta, which its neighbours are well apart from:
/// L D L' from above and U D U' from below meet where the residual is least. Source: B. N. Parlett,
/// I. S. Dhillon, Fernando's solution to Wilkinson's problem, Linear Algebra Appl. 267, 1997,
/// doi:10.1016/S0024-3795(97)80053-5. Returns the residual's norm.
double twisted_vector(const Vector& d, const Vector& e, double theta, double tiny, Vector& x) {
  const Eigen::Index n = d.size();
  Vector down(n), up(n);
  const auto pivot = [tiny](double p) { return std::abs(p) < tiny ? std::copysign(tiny, p) : p; };
  down[0] = pivot(d[0] - theta);
  for (Eigen::Index i = 1; i < n; ++i)
    down[i] = pivot(d[i] - theta - e[i - 1] * e[i - 1] / down[i - 1]);
  up[n - 1] = pivot(d[n - 1] - theta);
  for (Eigen::Index i = n - 1; i-- > 0;) up[i] = pivot(d[i] - theta - e[i] * e[i] / up[i + 1]);
  Eigen::Index twist = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double gamma = std::abs(down[i] + up[i] - (d[i] - theta));
    if (gamma < least) least = gamma, twist = i;
  }
  x.resize(n);
  x[twist] = 1.0;
  for (Eigen::Index i = twist; i-- > 0;) x[i] = -e[i] * x[i + 1] / down[i];
  for (Eigen::Index i = twist + 1; i < n; ++i) x[i] = -e[i - 1] * x[i - 1] / up[i];
  const double norm = x.norm();
  x /= norm;
  return least / norm;
}

/// h = Q' [a b] over the first count columns.
DREV_WIDEST void project(const double* q, int n, int count, const double* a, const double* b, double* h) {
  for (int i = 0; i < 2 * count; ++i) h[i] = 0.0;
  for (int start = 0; start < n; start += kLongStrip) {
    const int rows = std::min(kLongStrip, n - start);
    for (int i = 0; i < count; ++i) {
      const double* column = q + static_cast<std::ptrdiff_t>(i) * n + start;
      Lanes sum_a{}, sum_b{}, x, y, z;
      int k = 0;
      for (; k + kLanes <= rows; k += kLanes) {
        load(column + k, x);
        load(a + start + k, y);
        load(b + start + k, z);
        sum_a += x * y;
        sum_b += x * z;
      }
      for (int lane = 0; lane < kLanes; ++lane) h[2 * i] += sum_a[lane], h[2 * i + 1] += sum_b[lane];
      for (; k < rows; ++k) {
        h[2 * i] += column[k] * a[start + k];
        h[2 * i + 1] += column[k] * b[start + k];
      }
    }
  }
}

/// [a b] -= Q h. a may be a column of Q beyond count.
DREV_WIDEST void subtract(const double* q, int n, int count, const double* h, double* a, double* b) {
  for (int start = 0; start < n; start += kLongStrip) {
    const int rows = std::min(kLongStrip, n - start);
    for (int i = 0; i < count; ++i) {
      const double* column = q + static_cast<std::ptrdiff_t>(i) * n + start;
      const double h_a = h[2 * i], h_b = h[2 * i + 1];
      for (int k = 0; k < rows; ++k) {
        a[start + k] -= h_a * column[k];
        b[start + k] -= h_b * column[k];
      }
    }
  }
}

/// out = Q S, strip by strip: Q is read from memory once. S: count x outs.
DREV_WIDEST void combine(const double* q, int n, int count, const double* s, int outs, double* out) {
  const std::ptrdiff_t next = n;
  for (int start = 0; start < n; start += kShortStrip) {
    const int rows = std::min(kShortStrip, n - start);
    for (int o = 0; o < outs; ++o) {
      double* to = out + o * next + start;
      const double* f = s + o * count;
      for (int k = 0; k < rows; ++k) to[k] = 0.0;
      int i = 0;
      for (; i + 3 < count; i += 4) {
        const double* c = q + i * next + start;
        for (int k = 0; k < rows; ++k)
          to[k] += f[i] * c[k] + f[i + 1] * c[k + next] + f[i + 2] * c[k + 2 * next] +
                   f[i + 3] * c[k + 3 * next];
      }
      for (; i < count; ++i)
        for (int k = 0; k < rows; ++k) to[k] += f[i] * q[i * next + start + k];
    }
  }
}

/// w -= factor q; returns w' m.
DREV_WIDEST double subtract_and_project(double factor, const double* q, const double* m, int n, double* w) {
  Lanes sum{}, x, y;
  int k = 0;
  for (; k + kLanes <= n; k += kLanes) {
    load(w + k, x);
    load(q + k, y);
    x -= factor * y;
    store(x, w + k);
    load(m + k, y);
    sum += x * y;
  }
  double rest = 0.0;
  for (int lane = 0; lane < kLanes; ++lane) rest += sum[lane];
  for (; k < n; ++k) {
    w[k] -= factor * q[k];
    rest += w[k] * m[k];
  }
  return rest;
}

class Lanczos {
 public:
  Lanczos(const ShiftInvertProblem& problem, int sharp, double tolerance)
      : problem_(problem),
        n_(problem.size),
        sharp_(sharp),
        tolerance_(tolerance),
        most_(std::min(n_, problem.basis > 0 ? problem.basis : 3 * problem.count + 40)),
        q_(std::make_unique_for_overwrite<double[]>(at(n_) * at(most_))),
        w_(shift_invert_start(n_, problem.start)),
        h_(at(2 * most_)),
        omega_(at(most_ + 1), kEpsilon),
        omega_old_(at(most_ + 1), kEpsilon) {}

  ShiftInvertResult run() {
    problem_.mass(w_, mw_);
    accept(std::sqrt(w_.dot(mw_)));
    for (;;) {
      step();
      const bool last = columns_ == most_;
      const int beyond = columns_ - 2 * problem_.count;  // in small systems steps cost less than checks
      const bool due = n_ > 4 * problem_.count && beyond >= 0 && beyond % kBetweenChecks == 0;
      if (columns_ == n_ || ((last || due) && converged())) break;
      if (last) {
        result_.status = ArpackStatus::not_converged;
        result_.reason = std::to_string(most_) + " Lanczos vectors did not suffice";
        return std::move(result_);
      }
      accept(next_norm_);
    }
    finish();
    return std::move(result_);
  }

 private:
  Eigen::Map<Vector> column(int j) { return {q_.get() + static_cast<std::ptrdiff_t>(j) * n_, n_}; }

  /// w / norm becomes the next vector of the basis.
  void accept(double norm) {
    column(columns_++) = (1.0 / norm) * w_;
    std::swap(mq_, mw_);
    mq_ *= 1.0 / norm;
  }

  /// w = what A q adds to the basis; alpha, beta.
  void step() {
    const int j = columns_ - 1;
    problem_.solve(mq_, w_);
    ++result_.solves;
    if (j > 0)
      alpha_.push_back(subtract_and_project(beta_.back(), column(j - 1).data(), mq_.data(), n_, w_.data()));
    else
      alpha_.push_back(w_.dot(mq_));
    w_ -= alpha_.back() * column(j);
    problem_.mass(w_, mw_);
    double beta = std::sqrt(std::max(0.0, w_.dot(mw_)));
    largest_ = std::max({largest_, std::abs(alpha_.back()), beta});
    bool again = estimate(j, beta);
    for (int pass = 0; again && pass < 3; ++pass) {
      const double before = beta;
      reorthogonalise(j);
      problem_.mass(w_, mw_);
      beta = std::sqrt(std::max(0.0, w_.dot(mw_)));
      again = beta < 0.5 * before;  // much was taken away: what rounding left of it shows
    }
    beta_.push_back(beta);
    next_norm_ = beta;
    if (beta > std::max(n_, 100) * kEpsilon * largest_ || columns_ == most_) return;
    beta_.back() = 0.0;  // the space is used up: another start
    w_ = shift_invert_start(n_, problem_.start + columns_);
    for (int pass = 0; pass < 2; ++pass) {
      problem_.mass(w_, mw_);
      project(q_.get(), n_, columns_, mw_.data(), mw_.data(), h_.data());
      rest_ = w_;
      subtract(q_.get(), n_, columns_, h_.data(), rest_.data(), w_.data());
    }
    problem_.mass(w_, mw_);
    next_norm_ = std::sqrt(w_.dot(mw_));
    std::fill_n(omega_.begin(), columns_, kEpsilon);
  }

  /// Simon's recurrence of |Q' M q|; true where orthogonality is to be restored.
  bool estimate(int j, double beta) {
    std::vector<double> next(omega_.size(), kEpsilon);
    bool lost = false;
    for (int k = 0; k < j; ++k) {
      const double before = k > 0 ? beta_[at(k - 1)] * omega_[at(k - 1)] : 0.0;
      double sum = beta_[at(k)] * omega_[at(k + 1)] + (alpha_[at(k)] - alpha_[at(j)]) * omega_[at(k)] +
                   before - (j > 0 ? beta_[at(j - 1)] * omega_old_[at(k)] : 0.0);
      sum = (sum + std::copysign(2.0 * kEpsilon * largest_, sum)) / beta;
      next[at(k)] = sum;
      lost = lost || !(std::abs(sum) < std::sqrt(kEpsilon));
    }
    omega_old_ = omega_;
    omega_ = std::move(next);
    omega_[at(j + 1)] = 1.0;
    omega_old_[at(j)] = 1.0;
    return lost;
  }

  /// The new vector against all, and q_j against those before it (the recurrence carries both on).
  void reorthogonalise(int j) {
    project(q_.get(), n_, j, mq_.data(), mw_.data(), h_.data());
    subtract(q_.get(), n_, j, h_.data(), column(j).data(), w_.data());
    rest_ = column(j);
    problem_.mass(rest_, mq_);
    w_ -= w_.dot(mq_) * rest_;
    std::fill_n(omega_.begin(), j, kEpsilon);
    std::fill_n(omega_old_.begin(), j, kEpsilon);
  }

  /// Eigenvalues of T, largest first, into theta_; z's columns, in that order, if it has rows.
  bool tridiagonal(Eigen::MatrixXd& z) {
    d_ = Eigen::Map<const Vector>(alpha_.data(), columns_);
    e_ = Vector::Zero(columns_);
    e_.head(columns_ - 1) = Eigen::Map<const Vector>(beta_.data(), columns_ - 1);
    theta_ = d_;
    Vector e = e_;
    if (!tridiagonal_eigen(theta_, e, z)) return false;
    std::vector<int> order(at(columns_));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [this](int a, int b) { return theta_[a] > theta_[b]; });
    theta_ = Vector(theta_(order));
    if (z.rows() > 0) z = Eigen::MatrixXd(z(Eigen::all, order));
    return true;
  }

  bool converged() {
    Eigen::MatrixXd last = Eigen::MatrixXd::Zero(1, columns_);
    last(0, columns_ - 1) = 1.0;
    if (!tridiagonal(last)) return false;
    for (int i = 0; i < problem_.count; ++i) {
      const double limit = i < sharp_ ? tolerance_ : std::sqrt(tolerance_);
      if (!(std::abs(beta_.back() * last(0, i)) <= limit * theta_[i])) return false;
    }
    return true;
  }

  /// The first eigenvectors of T; one by one where they are well apart, else all by QL.
  bool vectors_of_t(Eigen::MatrixXd& s) {
    const int count = problem_.count;
    Eigen::MatrixXd z(0, columns_);
    if (!tridiagonal(z)) return false;
    bool apart = true;
    for (int i = 0; i < count && i + 1 < columns_; ++i)
      apart = apart && theta_[i] - theta_[i + 1] > kApart * theta_[0];
    s.resize(columns_, count);
    Vector x;
    for (int i = 0; i < count && apart; ++i) {
      apart = twisted_vector(d_, e_, theta_[i], kEpsilon * kEpsilon * theta_[0], x) <=
              columns_ * kEpsilon * theta_[0];
      s.col(i) = x;
    }
    if (apart) return true;
    z = Eigen::MatrixXd::Identity(columns_, columns_);
    if (!tridiagonal(z)) return false;
    s = z.leftCols(count);
    return true;
  }

  void finish() {
    const int count = problem_.count;
    Eigen::MatrixXd s;
    if (!vectors_of_t(s)) {
      result_.status = ArpackStatus::failed;
      result_.reason = "the tridiagonal eigenproblem did not converge";
      return;
    }
    result_.lambda = problem_.sigma + theta_.head(count).cwiseInverse().array();
    result_.vectors.resize(n_, count);
    combine(q_.get(), n_, columns_, s.data(), count, result_.vectors.data());
    result_.status = ArpackStatus::success;
  }

  const ShiftInvertProblem& problem_;
  const int n_, sharp_;
  const double tolerance_;
  const int most_;
  std::unique_ptr<double[]> q_;  // columns; untouched until used
  Vector w_, mw_, mq_, rest_, d_, e_, theta_;
  std::vector<double> alpha_, beta_, h_, omega_, omega_old_;
  double largest_ = 0.0, next_norm_ = 0.0;
  int columns_ = 0;
  ShiftInvertResult result_;
};

}  // namespace

ShiftInvertResult lanczos_shift_invert(const ShiftInvertProblem& problem, int sharp, double tolerance) {
  return Lanczos(problem, sharp, tolerance).run();
}

}  // namespace drev
