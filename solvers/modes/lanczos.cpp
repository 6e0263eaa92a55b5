#include "solvers/modes/lanczos.hpp"

#include <drev/core/lanes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "solvers/linear/huge_pages.hpp"
#include "solvers/linear/vector_kernels.hpp"

namespace drev {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kBetweenChecks = 3;
constexpr double kApart = 1e-5;  // distance over the largest eigenvalue of T: vectors are orthogonal
// Rows of a strip: two vectors that stay in the cache while the basis streams by, or all of the basis.
constexpr int kLongStrip = 4096, kShortStrip = 512;
constexpr Eigen::Index kKept = 1 << 22;  // doubles: no more than malloc keeps for the next call

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
  for (Eigen::Index i = 1; i < n; ++i) down[i] = pivot(d[i] - theta - e[i - 1] * e[i - 1] / down[i - 1]);
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

/// h = Q' [a b] over the first count columns, two at a time.
DREV_WIDEST void project(const double* q, int n, int count, const double* a, const double* b, double* h) {
  for (int i = 0; i < 2 * count; ++i) h[i] = 0.0;
  for (int start = 0; start < n; start += kLongStrip) {
    const int rows = std::min(kLongStrip, n - start);
    for (int i = 0; i < count; i += 2) {
      const double* p = q + static_cast<std::ptrdiff_t>(i) * n + start;
      const double* r = i + 1 < count ? p + n : p;
      Lanes p_a{}, p_b{}, r_a{}, r_b{}, x, y, u, v;
      int k = 0;
      for (; k + kLanes <= rows; k += kLanes) {
        load(p + k, x);
        load(r + k, y);
        load(a + start + k, u);
        load(b + start + k, v);
        p_a += x * u;
        p_b += x * v;
        r_a += y * u;
        r_b += y * v;
      }
      double sums[4] = {};
      for (int lane = 0; lane < kLanes; ++lane)
        sums[0] += p_a[lane], sums[1] += p_b[lane], sums[2] += r_a[lane], sums[3] += r_b[lane];
      for (; k < rows; ++k) {
        sums[0] += p[k] * a[start + k];
        sums[1] += p[k] * b[start + k];
        sums[2] += r[k] * a[start + k];
        sums[3] += r[k] * b[start + k];
      }
      for (int s = 0; s < (i + 1 < count ? 4 : 2); ++s) h[2 * i + s] += sums[s];
    }
  }
}

/// [a b] -= Q h. a may be a column of Q beyond count. Backwards: what project() read last is in the cache
/// yet.
DREV_WIDEST void subtract(const double* q, int n, int count, const double* h, double* a, double* b) {
  const std::ptrdiff_t next = n;
  for (int start = (n - 1) / kLongStrip * kLongStrip; start >= 0; start -= kLongStrip) {
    const int rows = std::min(kLongStrip, n - start);
    int i = 0;
    for (; i + 3 < count; i += 4) {
      const double *c = q + i * next + start, *f = h + 2 * i;
      for (int k = 0; k < rows; ++k) {
        const double c0 = c[k], c1 = c[k + next], c2 = c[k + 2 * next], c3 = c[k + 3 * next];
        a[start + k] -= f[0] * c0 + f[2] * c1 + f[4] * c2 + f[6] * c3;
        b[start + k] -= f[1] * c0 + f[3] * c1 + f[5] * c2 + f[7] * c3;
      }
    }
    for (; i < count; ++i)
      for (int k = 0; k < rows; ++k) {
        a[start + k] -= h[2 * i] * q[i * next + start + k];
        b[start + k] -= h[2 * i + 1] * q[i * next + start + k];
      }
  }
}

/// The first columns of Q become those of Q S, strip by strip: Q is read from memory once. S: count x outs.
DREV_WIDEST void combine(double* q, int n, int count, const double* s, int outs) {
  const std::ptrdiff_t next = n;
  std::vector<double> strip(idx(outs) * idx(kShortStrip));
  for (int start = 0; start < n; start += kShortStrip) {
    const int rows = std::min(kShortStrip, n - start);
    for (int o = 0; o < outs; ++o) {
      double* to = strip.data() + o * kShortStrip;
      const double* f = s + o * count;
      for (int k = 0; k < rows; ++k) to[k] = 0.0;
      int i = 0;
      for (; i + 3 < count; i += 4) {
        const double* c = q + i * next + start;
        for (int k = 0; k < rows; ++k)
          to[k] +=
              f[i] * c[k] + f[i + 1] * c[k + next] + f[i + 2] * c[k + 2 * next] + f[i + 3] * c[k + 3 * next];
      }
      for (; i < count; ++i)
        for (int k = 0; k < rows; ++k) to[k] += f[i] * q[i * next + start + k];
    }
    for (int o = 0; o < outs; ++o) std::copy_n(strip.data() + o * kShortStrip, rows, q + o * next + start);
  }
}

/// w -= factor q; returns w' m. m may be w.
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

DREV_WIDEST void scale(double factor, int n, double* x) {
  for (int k = 0; k < n; ++k) x[k] *= factor;
}

}  // namespace

struct ShiftInvertLanczos::Impl {
  explicit Impl(ShiftInvertProblem given)
      : problem(std::move(given)),
        n_(problem.size),
        most_(std::min(n_, problem.basis > 0 ? problem.basis : 3 * problem.count + 40)),
        q_(n_, most_ + 1),
        h_(idx(2 * most_)),
        omega_(idx(most_ + 1), kEpsilon),
        omega_old_(idx(most_ + 1), kEpsilon) {
    prefer_huge_pages(q_);
    if (problem.mass) mq_.resize(n_), mw_.resize(n_);
    q_.col(0) = shift_invert_start(n_, problem.start);
    next_norm_ = norm();
  }

  /// Steps until the first `count` pairs have converged, or all that can be made.
  ShiftInvertResult go_on(int count, int sharp, double tolerance) {
    ShiftInvertResult result;
    bool enough = columns_ == n_;
    while (!enough && columns_ < most_) {
      accept(next_norm_);
      step();
      ++result.solves;
      const int beyond = columns_ - 2 * count;  // in small systems steps cost less than checks
      const bool due = n_ > 4 * count && beyond >= 0 && beyond % kBetweenChecks == 0;
      enough = columns_ == n_ || ((columns_ == most_ || due) && converged(count, sharp, tolerance));
    }
    if (enough) {
      result.status = ArpackStatus::success;
    } else {
      result.status = ArpackStatus::not_converged;
      result.reason = std::to_string(most_) + " Lanczos vectors did not suffice";
    }
    return result;
  }

  /// theta_ as eigenvalues, or why not.
  void take_values(bool found, int count, ShiftInvertResult& result) const {
    if (found) {
      result.lambda = problem.sigma + theta_.head(count).cwiseInverse().array();
    } else {
      result.status = ArpackStatus::failed;
      result.reason = "the tridiagonal eigenproblem did not converge";
    }
  }

  /// The basis becomes the vectors T's are s of.
  void combine_into(const Eigen::MatrixXd& s, Eigen::MatrixXd& vectors) {
    const Eigen::Index count = s.cols();
    combine(q_.data(), n_, columns_, s.data(), static_cast<int>(count));
    if (q_.size() > kKept) {
      q_.conservativeResize(n_, count);  // gives the rest back to the system without copying
      vectors = std::move(q_);
    } else {
      vectors = q_.leftCols(count);
    }
  }

  double* column(int j) { return q_.data() + static_cast<std::ptrdiff_t>(j) * n_; }
  /// The new vector, behind those of the basis.
  double* w() { return column(columns_); }
  /// M times the last of the basis, and the new one as norm() leaves it.
  double* mq() { return problem.mass ? mq_.data() : column(columns_ - 1); }
  double* mw() { return problem.mass ? mw_.data() : w(); }

  double norm() {
    if (problem.mass) problem.mass(w(), mw());
    return std::sqrt(std::max(0.0, dot(n_, w(), mw())));
  }

  /// w / norm becomes the next vector of the basis.
  void accept(double norm) {
    scale(1.0 / norm, n_, w());
    ++columns_;
    if (!problem.mass) return;
    std::swap(mq_, mw_);
    scale(1.0 / norm, n_, mq());
  }

  /// w = what A q adds to the basis; alpha, beta.
  void step() {
    const int j = columns_ - 1;
    problem.solve(mq(), w());
    alpha_.push_back(j > 0 ? subtract_and_project(beta_.back(), column(j - 1), mq(), n_, w())
                           : dot(n_, w(), mq()));
    const double square = subtract_and_project(alpha_.back(), column(j), w(), n_, w());
    double beta = problem.mass ? norm() : std::sqrt(square);
    largest_ = std::max({largest_, std::abs(alpha_.back()), beta});
    bool again = estimate(j, beta);
    for (int pass = 0; again && pass < 3; ++pass) {
      const double whole = beta;
      reorthogonalise(j);
      beta = norm();
      again = beta < 0.5 * whole;  // much was taken away: what rounding left of it shows
    }
    beta_.push_back(beta);
    next_norm_ = beta;
    if (beta > std::max(n_, 100) * kEpsilon * largest_ || columns_ == most_) return;
    beta_.back() = 0.0;  // the space is used up: another start
    q_.col(columns_) = shift_invert_start(n_, problem.start + columns_);
    for (int pass = 0; pass < 2; ++pass) {
      norm();
      project(q_.data(), n_, columns_, mw(), mw(), h_.data());
      for (int i = 0; i < columns_; ++i) subtract_and_project(h_[idx(2 * i)], column(i), w(), n_, w());
    }
    next_norm_ = norm();
    std::fill_n(omega_.begin(), columns_, kEpsilon);
  }

  /// Simon's recurrence of |Q' M q|; true where orthogonality is to be restored.
  bool estimate(int j, double beta) {
    std::vector<double> next(omega_.size(), kEpsilon);
    bool lost = false;
    for (int k = 0; k < j; ++k) {
      const double before = k > 0 ? beta_[idx(k - 1)] * omega_[idx(k - 1)] : 0.0;
      double sum = beta_[idx(k)] * omega_[idx(k + 1)] + (alpha_[idx(k)] - alpha_[idx(j)]) * omega_[idx(k)] +
                   before - (j > 0 ? beta_[idx(j - 1)] * omega_old_[idx(k)] : 0.0);
      sum = (sum + std::copysign(2.0 * kEpsilon * largest_, sum)) / beta;
      next[idx(k)] = sum;
      lost = lost || !(std::abs(sum) < std::sqrt(kEpsilon));
    }
    omega_old_ = omega_;
    omega_ = std::move(next);
    omega_[idx(j + 1)] = 1.0;
    omega_old_[idx(j)] = 1.0;
    return lost;
  }

  /// The new vector against all, and q_j against those before it (the recurrence carries both on).
  void reorthogonalise(int j) {
    double* q = column(j);
    project(q_.data(), n_, j, mq(), mw(), h_.data());
    subtract(q_.data(), n_, j, h_.data(), q, w());
    if (problem.mass) problem.mass(q, mq());
    subtract_and_project(dot(n_, w(), mq()), q, w(), n_, w());
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
    std::vector<int> order(idx(columns_));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [this](int a, int b) { return theta_[a] > theta_[b]; });
    theta_ = Vector(theta_(order));
    if (z.rows() > 0) z = Eigen::MatrixXd(z(Eigen::all, order));
    return true;
  }

  bool converged(int count, int sharp, double tolerance) {
    Eigen::MatrixXd last = Eigen::MatrixXd::Zero(1, columns_);
    last(0, columns_ - 1) = 1.0;
    if (!tridiagonal(last)) return false;
    for (int i = 0; i < count; ++i) {
      const double limit = i < sharp ? tolerance : std::sqrt(tolerance);
      if (!(std::abs(beta_.back() * last(0, i)) <= limit * theta_[i])) return false;
    }
    return true;
  }

  /// The first eigenvectors of T; one by one where they are well apart, else all by QL.
  bool vectors_of_t(int count, Eigen::MatrixXd& s) {
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

  const ShiftInvertProblem problem;
  const int n_, most_;
  Eigen::MatrixXd q_;  // a column is untouched until used
  Vector mw_, mq_, d_, e_, theta_;
  std::vector<double> alpha_, beta_, h_, omega_, omega_old_;
  double largest_ = 0.0, next_norm_ = 0.0;
  int columns_ = 0;
};

ShiftInvertLanczos::ShiftInvertLanczos(ShiftInvertProblem problem)
    : impl_(std::make_unique<Impl>(std::move(problem))) {}
ShiftInvertLanczos::~ShiftInvertLanczos() = default;
int ShiftInvertLanczos::count() const { return impl_->problem.count; }

ShiftInvertResult ShiftInvertLanczos::values(int count, double tolerance) {
  ShiftInvertResult result = impl_->go_on(count, count, tolerance);
  Eigen::MatrixXd none(0, impl_->columns_);
  if (result.status == ArpackStatus::success) impl_->take_values(impl_->tridiagonal(none), count, result);
  return result;
}

ShiftInvertResult ShiftInvertLanczos::pairs(int sharp, double tolerance) {
  const int count = impl_->problem.count;
  ShiftInvertResult result = impl_->go_on(count, sharp, tolerance);
  if (result.status != ArpackStatus::success) return result;
  Eigen::MatrixXd s;
  impl_->take_values(impl_->vectors_of_t(count, s), count, result);
  if (result.status == ArpackStatus::success) impl_->combine_into(s, result.vectors);
  return result;
}

}  // namespace drev
