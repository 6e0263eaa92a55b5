#include "solvers/periodic/harmonic_balance.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <set>

#include "core/dense/factorization.hpp"
#include "core/dense/fourier.hpp"
#include "core/names/rounded_text.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr int kMaxNewton = 40;
constexpr int kMaxGmres = 60;
constexpr double kGmresTolerance = 1e-3;
/// Largest ratio of K |z| + w^2 M |z| to the load that causes z [-]; above it, cancellation leaves fewer than
/// 5 digits.
constexpr double kResonance = 1e10;
/// Harmonic of the force on an unknown beside the largest of them that is rounding of the transform [-].
constexpr double kNoForce = 1e-13;

/// The pattern with each entry (a + i b) replaced by [a -b; b a].
SparseMatrix real_pattern(const SparseMatrix& p) {
  const auto n = static_cast<int>(p.cols());
  SparseMatrix real(2 * n, 2 * n);
  real.reserve(4 * p.nonZeros());
  for (int column = 0; column < n; ++column)
    for (int half = 0; half < 2; ++half) {
      real.startVec(2 * column + half);
      for (SparseMatrix::InnerIterator it(p, column); it; ++it)
        for (int row = 0; row < 2; ++row)
          real.insertBack(2 * static_cast<int>(it.row()) + row, 2 * column + half) = 1.0;
    }
  real.finalize();
  return real;
}

}  // namespace

HarmonicBalance::HarmonicBalance(const System& system, double period)
    : system_(system),
      assembler_(system),
      loads_(system),
      w_(kTwoPi / period),
      history_(State::initial(system).history),
      pattern_(real_pattern(system.pattern())),
      factor_(pattern_) {
  assembler_.contact_values({0.0, 0.0, 1.0}, Contact::closed, closed_k_);
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, closed_c_);
  scale_.resize(2 * system.size());
  for (int i = 0; i < system.size(); ++i) {
    const int s = system.diagonal_slots()[idx(i)];
    scale_[2 * i] = scale_[2 * i + 1] = std::abs(closed_k_[s]) + w_ * w_ * system.mass_values()[s];
  }
  std::set<int> varying;
  for (const ScalarTerm& term : system.scalars()) varying.insert(term.slots.begin(), term.slots.end());
  for (const LoadTerm& term : system.loads())
    if (term.load->depends_on_motion() && system.node_map(term.node).prescribed < 0)
      feedback_.push_back({&term, system.row_of(term.node)});
  for (const GeneralTerm& term : system.generals()) varying.insert(term.slots.begin(), term.slots.end());
  const SparseMatrix& p = system.pattern();
  for (int column = 0; column < p.cols(); ++column)
    for (int s = p.outerIndexPtr()[column]; s < p.outerIndexPtr()[column + 1]; ++s)
      if (varying.contains(s)) slopes_.push_back({p.innerIndexPtr()[s], column, s});
}

double HarmonicBalance::inner(const Harmonics& a, const Harmonics& b) const {
  double sum = 0.0;
  for (Eigen::Index n = 0; n < a.cols(); ++n) {
    const Eigen::Map<const Vector> x(reinterpret_cast<const double*>(a.col(n).data()), scale_.size()),
        y(reinterpret_cast<const double*>(b.col(n).data()), scale_.size());
    const double part = x.cwiseProduct(y).dot(scale_);
    sum += n == 0 ? part : 0.5 * part;
  }
  return sum;
}

double HarmonicBalance::size(const Harmonics& z) const { return std::sqrt(inner(z, z)); }

HarmonicBalance::Samples HarmonicBalance::motion(const Harmonics& z, int derivative, int samples) const {
  Samples all(z.rows(), samples);
  FourierTransform transform;
  std::vector<Complex> lines(idx(samples / 2 + 1)), factors;
  for (Eigen::Index n = 0; n < z.cols(); ++n)
    factors.push_back((n == 0 ? 1.0 : 0.5) * samples *
                      std::pow(Complex(0.0, w_ * static_cast<double>(n)), derivative));
  std::vector<double> values(idx(samples));
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    for (std::size_t n = 0; n < factors.size(); ++n)
      lines[n] = z(i, static_cast<Eigen::Index>(n)) * factors[n];
    transform.inverse(values, lines, samples);
    for (int s = 0; s < samples; ++s) all(i, s) = values[idx(s)];
  }
  return all;
}

HarmonicBalance::Harmonics HarmonicBalance::to_harmonics(const Samples& samples, int harmonics) {
  Harmonics all(samples.rows(), harmonics + 1);
  const auto count = static_cast<int>(samples.cols());
  FourierTransform transform;
  std::vector<Complex> lines;
  std::vector<double> values(idx(count));
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    for (int s = 0; s < count; ++s) values[idx(s)] = samples(i, s);
    transform.forward(lines, values);
    for (int n = 0; n <= harmonics; ++n) all(i, n) = lines[idx(n)] * ((n == 0 ? 1.0 : 2.0) / count);
  }
  return all;
}

HarmonicBalance::Samples HarmonicBalance::forces(const Samples& q, const Samples& v, double later,
                                                 bool all_loads) {
  const auto samples = static_cast<int>(q.cols());
  Samples all(q.rows(), samples);
  Vector q_s, v_s, p, f(q.rows()), history(history_.size());
  for (int s = 0; s < samples; ++s) {
    assembler_.set_time(kTwoPi / w_ * (static_cast<double>(s) / samples + later));
    q_s = q.col(s);
    v_s = v.col(s);
    if (all_loads) {
      assembler_.external(q_s, v_s, p);
    } else {
      assembler_.external_of_motions(p);
      for (const int l : loads_.others()) {
        const LoadTerm& term = system_.loads()[idx(l)];
        assembler_.add_torque(system_.node_map(term.node), assembler_.load(term, q_s, v_s).torque, p);
      }
    }
    f.setZero();
    assembler_.add_scalar_forces(q_s, v_s, f);
    assembler_.add_general_forces(q_s, v_s, history_, f, history);
    all.col(s) = p - f;
  }
  return all;
}

HarmonicBalance::Harmonics HarmonicBalance::force_harmonics(const Harmonics& z, int samples) {
  const Samples q = motion(z, 0, samples), v = motion(z, 1, samples);
  Harmonics f = to_harmonics(forces(q, v, 0.0, false), static_cast<int>(z.cols()) - 1);
  loads_.add(w_, q, v, f);
  return f;
}

double HarmonicBalance::aperiodicity(const Harmonics& z, int samples) {
  const Samples q = motion(z, 0, samples), v = motion(z, 1, samples);
  const Samples now = forces(q, v, 0.0, true), then = forces(q, v, 1.0, true);
  const double largest = now.cwiseAbs().maxCoeff();
  return largest > 0.0 ? (now - then).cwiseAbs().maxCoeff() / largest : 0.0;
}

bool HarmonicBalance::solve_stiffness(Harmonics& right) {
  const SparseMatrix& p = system_.pattern();
  Vector values(4 * p.nonZeros()), x(2 * right.rows());
  // Without laws no harmonic reaches another one: where nothing acts nothing moves, even at an undamped resonance.
  for (Eigen::Index i = 0; linear() && i < right.rows(); ++i) {
    const double none = kNoForce * right.row(i).cwiseAbs().maxCoeff();
    for (Eigen::Index n = 0; n < right.cols(); ++n)
      if (std::abs(right(i, n)) <= none) right(i, n) = 0.0;
  }
  for (Eigen::Index n = 0; n < right.cols(); ++n) {
    if (linear() && right.col(n).isZero(0.0)) continue;
    const double w = w_ * static_cast<double>(n);
    for (int column = 0, to = 0; column < p.cols(); ++column)
      for (int half = 0; half < 2; ++half)
        for (int s = p.outerIndexPtr()[column]; s < p.outerIndexPtr()[column + 1]; ++s) {
          const double a = closed_k_[s] - w * w * system_.mass_values()[s], b = w * closed_c_[s];
          values[to++] = half == 0 ? a : -b;
          values[to++] = half == 0 ? b : a;
        }
    const double load = right.col(n).cwiseAbs().maxCoeff();
    Eigen::Map<Vector> of_n(reinterpret_cast<double*>(right.col(n).data()), x.size());
    x = of_n;
    const bool factored = factor_.factorize(pattern_, values) == FactorStatus::success;
    if (factored) factor_.solve(x, x);
    of_n = x;
    double inside = 0.0;  // sum of the forces, which nearly cancel
    for (int column = 0; column < p.cols(); ++column) {
      double sum = 0.0;
      for (int s = p.outerIndexPtr()[column]; s < p.outerIndexPtr()[column + 1]; ++s)
        sum += (std::abs(closed_k_[s]) + w * w * std::abs(system_.mass_values()[s])) *
               std::abs(right(p.innerIndexPtr()[s], n));
      inside = std::max(inside, sum);
    }
    if (!factored || !(inside <= kResonance * load)) {
      singular_harmonic_ = static_cast<int>(n);
      return false;
    }
  }
  return true;
}

bool HarmonicBalance::correction(const Harmonics& z, int samples, Harmonics& out) {
  out = force_harmonics(z, samples);
  // The closed slopes are on both sides of the equation: S_n Z_n on the left is exact whatever the contacts
  // do.
  Vector dk = closed_k_ - system_.stiffness_values(), dc = closed_c_ - system_.damping_values();
  Vector re, im, k_re, k_im, c_re, c_im;
  for (Eigen::Index n = 0; n < z.cols(); ++n) {
    const double w = w_ * static_cast<double>(n);
    re = z.col(n).real();
    im = z.col(n).imag();
    assembler_.multiply(dk, re, k_re);
    assembler_.multiply(dk, im, k_im);
    assembler_.multiply(dc, re, c_re);
    assembler_.multiply(dc, im, c_im);
    out.col(n).real() += k_re - w * c_im;
    out.col(n).imag() += k_im + w * c_re;
  }
  if (!solve_stiffness(out)) return false;
  out -= z;
  return true;
}

HarmonicBalance::Outcome HarmonicBalance::start(int harmonics, int samples, Harmonics& z) {
  z = force_harmonics(Harmonics::Zero(system_.size(), harmonics + 1), samples);
  Harmonics right = z.leftCols(1);
  if (!solve_stiffness(z)) return {.reason = singular()};
  bool gap = false;
  for (const ScalarTerm& term : system_.scalars())
    if (const auto g = term.force->gap()) {
      gap = true;
      double x = 0.0;
      for (const Entry& e : term.z) x += e.coeff * z(e.index, 0).real();
      const double edge = (x < 0.0 ? g->low : g->high) * term.force->closed_stiffness();
      for (const Entry& e : term.z) right(e.index, 0) += e.coeff * edge;
    }
  if (!gap) return {};
  if (!solve_stiffness(right)) return {.reason = singular()};
  z.col(0) = right.col(0);
  return {};
}

void HarmonicBalance::find_slopes(const Harmonics& z, int samples) {
  const auto count = static_cast<Eigen::Index>(slopes_.size());
  dk_.resize(count + static_cast<Eigen::Index>(feedback_.size()), samples);
  dc_.resize(dk_.rows(), samples);
  const Samples q = motion(z, 0, samples), v = motion(z, 1, samples);
  Vector q_s, v_s, k, c;
  for (int s = 0; s < samples; ++s) {
    assembler_.set_time(kTwoPi / w_ * (static_cast<double>(s) / samples));
    q_s = q.col(s);
    v_s = v.col(s);
    assembler_.tangent_values({0.0, 0.0, 1.0}, q_s, v_s, history_, false, k);
    assembler_.tangent_values({0.0, 1.0, 0.0}, q_s, v_s, history_, false, c);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int slot = slopes_[static_cast<std::size_t>(i)].slot;
      dk_(i, s) = k[slot] - closed_k_[slot];
      dc_(i, s) = c[slot] - closed_c_[slot];
    }
    for (Eigen::Index i = count; i < dk_.rows(); ++i) {
      const LoadResponse r = assembler_.load(*feedback_[static_cast<std::size_t>(i - count)].term, q_s, v_s);
      dk_(i, s) = -r.dtorque_dangle;
      dc_(i, s) = -r.dtorque_dspeed;
    }
  }
}

bool HarmonicBalance::apply(const Harmonics& d, int samples, Harmonics& out) {
  const Samples q = motion(d, 0, samples), v = motion(d, 1, samples);
  Samples f = Samples::Zero(d.rows(), samples);
  for (std::size_t i = 0; i < slopes_.size(); ++i) {
    const Slope& e = slopes_[i];
    const auto row = static_cast<Eigen::Index>(i);
    f.row(e.row) += dk_.row(row).cwiseProduct(q.row(e.column)) + dc_.row(row).cwiseProduct(v.row(e.column));
  }
  for (std::size_t i = 0; i < feedback_.size(); ++i) {
    const auto of = static_cast<Eigen::Index>(slopes_.size() + i);
    Eigen::RowVectorXd q_node = Eigen::RowVectorXd::Zero(samples), v_node = q_node;
    for (const Entry& e : feedback_[i].row) {
      q_node += e.coeff * q.row(e.index);
      v_node += e.coeff * v.row(e.index);
    }
    const Eigen::RowVectorXd torque = dk_.row(of).cwiseProduct(q_node) + dc_.row(of).cwiseProduct(v_node);
    for (const Entry& e : feedback_[i].row) f.row(e.index) += e.coeff * torque;
  }
  out = to_harmonics(f, static_cast<int>(d.cols()) - 1);
  if (!solve_stiffness(out)) return false;
  out += d;
  return true;
}

bool HarmonicBalance::direction(const Harmonics& right, int samples, Harmonics& d) {
  const double size_0 = size(right);
  std::vector<Harmonics> basis{right / size_0};
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kMaxGmres + 1, kMaxGmres);
  Vector y;
  for (int m = 1; m <= kMaxGmres; ++m) {
    Harmonics next;
    if (!apply(basis.back(), samples, next)) return false;
    for (int j = 0; j < m; ++j) {
      h(j, m - 1) = inner(basis[idx(j)], next);
      next -= h(j, m - 1) * basis[idx(j)];
    }
    h(m, m - 1) = size(next);
    Vector right_side = Vector::Zero(m + 1);
    right_side[0] = size_0;
    const Eigen::MatrixXd part = h.topLeftCorner(m + 1, m);
    y = least_squares(part, right_side);
    if ((part * y - right_side).norm() <= kGmresTolerance * size_0) break;
    basis.push_back(next / h(m, m - 1));
  }
  d = Harmonics::Zero(right.rows(), right.cols());
  for (Eigen::Index j = 0; j < y.size(); ++j) d += y[j] * basis[static_cast<std::size_t>(j)];
  return true;
}

HarmonicBalance::Outcome HarmonicBalance::solve(int harmonics, int samples, double tolerance, Harmonics& z) {
  constexpr double kShortest = 1.0 / 128;
  Outcome outcome;
  Harmonics padded = Harmonics::Zero(z.rows(), harmonics + 1);
  padded.leftCols(std::min(z.cols(), padded.cols())) = z.leftCols(std::min(z.cols(), padded.cols()));
  z = std::move(padded);
  Harmonics error, trial, trial_error, d;
  if (!correction(z, samples, error)) return {.reason = singular()};
  for (double left = size(error);; ++outcome.iterations) {
    const double largest = size(z);
    outcome.residual = left > 0.0 ? left / largest : 0.0;
    // The last correction is applied even so: in the highest harmonics it is small in the norm only.
    if (left == 0.0 || (linear() && left <= tolerance * largest)) {
      z += error;
      return outcome;
    }
    if (linear()) {
      d = error;
    } else {
      find_slopes(z, samples);
      if (!direction(error, samples, d)) return {.reason = singular()};
    }
    // S^-1 R estimates the error only where the slopes are the closed ones; Newton's step does so everywhere.
    const double step = size(d);
    outcome.residual = step / largest;
    if (step <= tolerance * largest) {
      z += d;
      return outcome;
    }
    if (outcome.iterations == kMaxNewton) break;
    double part = 1.0, then = 0.0;
    for (; part >= kShortest; part /= 2) {
      trial = z + part * d;
      if (!correction(trial, samples, trial_error)) return {.reason = singular()};
      then = size(trial_error);
      if (then <= (1.0 - 1e-2 * part) * left) break;
    }
    if (part < kShortest) break;
    z.swap(trial);
    error.swap(trial_error);
    left = then;
  }
  outcome.reason = "harmonic balance did not converge: after " + std::to_string(outcome.iterations) +
                   " iterations the residual is " + rounded_text(outcome.residual, 3) + " of the motion";
  return outcome;
}

std::string HarmonicBalance::singular() const {
  return "the dynamic stiffness is singular at harmonic " + std::to_string(singular_harmonic_) + ", " +
         to_text(to_hz(w_ * singular_harmonic_)) + " Hz: an undamped resonance";
}

}  // namespace drev
