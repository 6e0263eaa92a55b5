#include "solvers/stepping/stability_limit.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include <cmath>
#include <functional>
#include <limits>

#include "core/dense/eigenvalues.hpp"
#include "core/names/rounded_text.hpp"
#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/stepping/butcher_tableau.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;
constexpr Eigen::Index kKrylov = 120;
constexpr int kPhases = 720;          // at which a law's slope is asked for
constexpr double kGrowth = 1e-10;     // |R| - 1 that passes
constexpr double kRigid = 1e-6;       // relative to the fastest: no vibration
constexpr double kLargestAngle = 20;  // |lambda| h beyond which no explicit method is stable

/// M, and C and K with every law at its largest slopes.
class Linearised {
 public:
  explicit Linearised(const System& system)
      : assembler_(system), k_(system.stiffness_values()), c_(system.damping_values()) {
    if (mass_.factorize(system.pattern(), system.mass_values()) != FactorStatus::success)
      throw SolverError(system.name() + ": the mass matrix is not positive definite");
    for (const ScalarTerm& term : system.scalars()) {
      double slope = term.force->closed_stiffness();
      if (term.phase_node >= 0)
        for (int i = 0; i < kPhases; ++i) {
          const double angle = 2.0 * M_PI * i / kPhases, far = 1.0;
          slope = std::max(slope, term.force->evaluate({far, 0.0, 0.0, angle}).dy_dx);
        }
      add(term, slope, k_);
      add(term, term.force->closed_damping(), c_);
    }
  }

  /// out = M^-1 K x, M^-1 C x.
  void stiffness(const Vector& x, Vector& out) { apply(k_, x, out); }
  void damping(const Vector& x, Vector& out) { apply(c_, x, out); }

 private:
  static void add(const ScalarTerm& term, double slope, Vector& values) {
    std::size_t s = 0;
    for (const Entry& row : term.z)
      for (const Entry& col : term.z) values[term.slots[s++]] += slope * row.coeff * col.coeff;
  }
  void apply(const Vector& values, const Vector& x, Vector& out) {
    assembler_.multiply(values, x, product_);
    mass_.solve(product_, out);
  }

  Assembler assembler_;
  Vector k_, c_, product_;
  SparseCholesky mass_;
};

/// Ritz values; residual: |A u - theta u| of the one of largest size.
std::vector<Complex> arnoldi(const std::function<void(const Vector&, Vector&)>& apply, Eigen::Index size,
                             double& residual) {
  const Eigen::Index steps = std::min(size, kKrylov);
  Eigen::MatrixXd q(size, steps + 1), h = Eigen::MatrixXd::Zero(steps + 1, steps);
  for (Eigen::Index i = 0; i < size; ++i) q(i, 0) = 1.0 + std::sin(3.0 * static_cast<double>(i + 1));
  q.col(0).normalize();
  Eigen::Index m = 0;
  Vector w;
  while (m < steps) {
    apply(q.col(m), w);
    const double before = w.norm();
    for (int pass = 0; pass < 2; ++pass) {
      const Vector part = q.leftCols(m + 1).transpose() * w;
      h.col(m).head(m + 1) += part;
      w.noalias() -= q.leftCols(m + 1) * part;
    }
    h(m + 1, m) = w.norm();
    ++m;
    if (h(m, m - 1) <= 1e-13 * before) {
      h(m, m - 1) = 0.0;
      break;
    }
    if (m < size) q.col(m) = w / h(m, m - 1);
  }
  if (m == size) h(m, m - 1) = 0.0;
  const GeneralEigen eigen = general_eigen(h.topLeftCorner(m, m));
  if (!eigen.converged) throw SolverError("stability limit: the dense eigensolver did not converge");
  std::vector<Complex> values(static_cast<std::size_t>(m));
  Eigen::Index largest = 0;
  for (Eigen::Index i = 0; i < m; ++i) {
    values[static_cast<std::size_t>(i)] = eigen.values[i];
    if (std::abs(eigen.values[i]) > std::abs(eigen.values[largest])) largest = i;
  }
  const Eigen::VectorXcd u = eigen.vectors.col(largest);
  residual = h(m, m - 1) * std::abs(u[m - 1]) / u.norm();
  return values;
}

/// Largest omega^2 of M^-1 K.
double largest_stiffness(Linearised& motion, Eigen::Index n) {
  double residual = 0.0, largest = 0.0;
  for (const Complex& value :
       arnoldi([&](const Vector&x, Vector&out) { motion.stiffness(x, out); }, n, residual))
    largest = std::max(largest, value.real());
  return largest + residual;
}

/// R(x) of an explicit method.
Complex growth(const ButcherTableau& t, Complex x) {
  Eigen::VectorXcd y(t.stages());
  Complex sum = 1.0;
  for (int i = 0; i < t.stages(); ++i) {
    y[i] = 1.0;
    for (int j = 0; j < i; ++j) y[i] += x * t.a(i, j) * y[j];
    sum += x * t.b[i] * y[i];
  }
  return sum;
}

/// Largest r such that |R(rho e^(i phi))| <= 1 for all rho <= r.
double stable_radius(const ButcherTableau& t, Complex direction) {
  const auto stable = [&](double r) { return std::abs(growth(t, r * direction)) <= 1.0 + kGrowth; };
  double low = 0.0, high = 0.02;
  for (; stable(high) && high < kLargestAngle; high += 0.02) low = high;
  while (high - low > 1e-12 * high) (stable(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace

std::vector<std::complex<double>> fast_eigenvalues(const System& system) {
  Linearised motion(system);
  const Eigen::Index n = system.size();
  // Rates are scaled with the fastest frequency, which balances both halves.
  const double omega = std::sqrt(std::max(largest_stiffness(motion, n), 1e-300));
  Vector part;
  double residual = 0.0;
  std::vector<Complex> values = arnoldi(
      [&](const Vector& x, Vector& out) {
        out.resize(2 * n);
        out.head(n) = omega * x.tail(n);
        motion.stiffness(x.head(n), part);
        out.tail(n) = -part / omega;
        motion.damping(x.tail(n), part);
        out.tail(n) -= part;
      },
      2 * n, residual);
  double largest = 0.0;
  for (const Complex& value : values) largest = std::max(largest, std::abs(value));
  for (Complex& value : values) {
    if (largest > 0.0) value *= 1.0 + residual / largest;
    // What rounding makes of an undamped mode.
    if (value.real() > -1e-10 * largest) value.real(0.0);
  }
  return values;
}

double stability_limit(const System& system, const StepScheme& scheme) {
  double limit = std::numeric_limits<double>::infinity();
  if (scheme.is_explicit()) {
    const std::vector<Complex> values = fast_eigenvalues(system);
    double largest = 0.0;
    for (const Complex& value : values) largest = std::max(largest, std::abs(value));
    for (const Complex& value : values)
      if (const double size = std::abs(value); size > kRigid * largest)
        limit = std::min(limit, stable_radius(*scheme.tableau, value / size) / size);
    return limit;
  }
  const double gap = 0.5 * scheme.gamma - scheme.beta;
  if (scheme.tableau || scheme.alpha_f != 0.0 || scheme.alpha_m != 0.0 || !(gap > 1e-12)) return limit;
  Linearised motion(system);
  const double omega = std::sqrt(largest_stiffness(motion, system.size()));
  if (!(omega > 0.0)) return limit;
  limit = 1.0 / (std::sqrt(gap) * omega);
  const double excess = scheme.gamma - 0.5;
  if (excess == 0.0) return limit;
  // Damping raises it, mode by mode; where one does not oscillate, nothing is counted on.
  double damped = std::numeric_limits<double>::infinity();
  for (const Complex& value : fast_eigenvalues(system)) {
    const double size = std::abs(value), x = -value.real() / size * excess;
    if (size <= kRigid * omega) continue;
    if (value.imag() == 0.0) return limit;
    damped = std::min(damped, (x + std::sqrt(gap + x * x)) / (gap * size));
  }
  return damped;
}

std::optional<std::string> why_unstable(const System& system, const StepScheme& scheme, double step) {
  constexpr int kDigits = 6;
  constexpr double kDown = 1.0 - 1e-5;  // so that the number said, once rounded, is below the limit
  const double limit = stability_limit(system, scheme);
  if (step <= limit * (1.0 + 1e-9)) return {};
  return "is above the stability limit of " + scheme.name + " for this system, " +
         rounded_text(limit * kDown, kDigits) + " s";
}

}  // namespace drev
