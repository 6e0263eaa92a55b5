#include "solvers/periodic/law_balance.hpp"

#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/law/law_force.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

using BalanceComplex = LawBalance::Complex;

constexpr double kNoBalanceDrag = 1e-13;  // drag relative to speed times largest damping that is rounding [-]
constexpr int kMostCorrections = 8;       // largest number of corrections after doubling the harmonics
constexpr double kCorrected = 1e-3;       // last correction relative to the first one [-]

bool same_row(const std::vector<Entry>& a, const std::vector<Entry>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Entry& x, const Entry& y) { return x.index == y.index && x.coeff == y.coeff; });
}

/// Where slopes of a law may jump: its kinks, and each bound of its pieces that depends on x' once, with b_v > 0.
std::vector<LawBound> bounds_of(const ScalarForce& force) {
  std::vector<LawBound> bounds;
  for (const double kink : force.kinks()) bounds.push_back({-kink, 1.0, 0.0});
  for (const LawPiece& piece : force.pieces())
    for (const LawBound& b : piece.bounds) {
      if (b.b_v == 0.0) continue;
      const double sign = b.b_v > 0.0 ? 1.0 : -1.0;
      const LawBound one{sign * b.a, sign * b.b_x, sign * b.b_v};
      if (std::none_of(bounds.begin(), bounds.end(), [&](const LawBound& o) {
            return o.a == one.a && o.b_x == one.b_x && o.b_v == one.b_v;
          }))
        bounds.push_back(one);
    }
  return bounds;
}

}  // namespace

LawBalance::LawBalance(const System& system, double turns, const std::string& balance,
                       std::vector<Finding>& findings)
    : system_(system),
      turns_(turns),
      direction_(reference_direction(system)),
      assembler_(system),
      mass_(system.mass_values()),
      damping_(system.damping_values()),
      stiffness_(system.stiffness_values()),
      loss_(Vector::Zero(system.stiffness_values().size())),
      elimination_(system.pattern()) {
  const std::size_t before = findings.size();
  find_terms(findings);
  content_.emplace(system, std::vector<double>{}, findings);
  for (const LoadTerm* load : content_->loads()) load_rows_.push_back(system.row_of(load->node));
  if (findings.size() > before) return;
  Vector damping;
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping);
  mean_.emplace(system, damping, stiffness_, balance, findings);
  known_knots();
}

void LawBalance::find_terms(std::vector<Finding>& findings) {
  const auto refuse = [&](ElementId element, const std::string& why) {
    findings.push_back(
        {system_.name() + "/" + system_.element_instances()[idx(index(element))].name, "", "", "", why});
  };
  const auto input = [&](const std::vector<Entry>& row) {
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (same_row(row, inputs_[i])) return static_cast<int>(i);
    inputs_.push_back(row);
    return static_cast<int>(inputs_.size()) - 1;
  };
  for (const ScalarTerm& law : system_.scalars()) {
    Term term;
    term.law = &law;
    term.row = law.z;
    term.x = input(law.z);
    term.stiffness = law.force->closed_stiffness();
    term.gap = law.force->gap();
    term.bounds = bounds_of(*law.force);
    if (law.phase_node >= 0 && law.varies) {
      term.angle_row = system_.row_of(law.phase_node);
      if (!term.angle_row.empty()) term.angle = input(term.angle_row);
    }
    for (std::size_t a = 0, at = 0; a < law.z.size(); ++a)
      for (std::size_t b = 0; b < law.z.size(); ++b, ++at)
        loss_[law.slots[at]] += term.stiffness * law.z[a].coeff * law.z[b].coeff;
    terms_.push_back(std::move(term));
  }
  stiffness_ += loss_;
  for (const LoadTerm& load : system_.loads()) {
    if (!load.load->depends_on_motion() || system_.node_map(load.node).prescribed >= 0) continue;
    Term term;
    term.load = &load;
    term.row = system_.row_of(load.node);
    term.x = input(term.row);
    terms_.push_back(std::move(term));
  }
  if (const auto why = why_not_friction(system_, "a sweep"))
    findings.push_back({system_.name(), "", "", "", *why});
  if (const auto why = system_.why_not_varying_inertia("a sweep"))
    findings.push_back({system_.name(), "", "", "", *why});
  for (const GeneralTerm& term : system_.generals())
    refuse(term.element, "is a general element, which a sweep of a nonlinear model does not take");
  for (int k = 0; system_.any_prescribed_moves() && k < system_.prescribed_count(); ++k)
    if (system_.prescribed()[idx(k)].at)
      findings.push_back({system_.name() + "/" + system_.node_names()[idx(system_.prescribed_node(k))], "",
                          "", "", "has a given motion in time, which has no orders"});
}

void LawBalance::set_harmonics(int harmonics) {
  if (harmonics == harmonics_) return;
  harmonics_ = harmonics;
  known_harmonics_ = -1;
  std::vector<double> orders;
  for (int n = 1; n <= harmonics; ++n) orders.push_back(n / turns_);
  std::vector<Finding> none;
  content_.emplace(system_, orders, none);
  // Gauss's rule over panels of 10/(2 H) integrates products of two harmonics to 1e-7, even for the highest.
  even_ = std::max(16, static_cast<int>(std::ceil(1.3 * harmonics)));
  table_.resize(static_cast<Eigen::Index>(even_) * kPoints, 2 * harmonics + 1);
  for (Eigen::Index i = 0; i < table_.rows(); ++i) {
    const int g = static_cast<int>(i) % kPoints;
    const double side = g < kPoints / 2 ? -kGaussPoints[idx(kPoints / 2 - 1 - g)] : kGaussPoints[idx(g - 4)];
    const double psi = kTwoPi / even_ * (static_cast<double>(i / kPoints) + 0.5 + 0.5 * side);
    const Complex one = std::polar(1.0, psi);
    Complex power = 1.0;
    table_(i, 0) = 1.0;
    for (int n = 1; n <= harmonics; ++n) {
      power *= one;
      table_(i, 2 * n - 1) = power.real();
      table_(i, 2 * n) = -power.imag();
    }
  }
}

Vector LawBalance::resized(const Vector& x, int from, int to) const {
  const Eigen::Index old = 2 * from + 1, now = 2 * to + 1, kept = std::min(old, now);
  Vector out = Vector::Zero(inputs() * now);
  for (int i = 0; i < inputs(); ++i) out.segment(i * now, kept) = x.segment(i * old, kept);
  return out;
}

LawBalance::Complex LawBalance::line(const Vector& x, int input, int n) const {
  const Eigen::Index at = static_cast<Eigen::Index>(input) * (2 * harmonics_ + 1);
  return n == 0 ? Complex(x[at], 0.0) : Complex(x[at + 2 * n - 1], x[at + 2 * n]);
}

bool LawBalance::stiffness(int n, double speed) {
  const double w = n * speed / turns_;
  damping_here_ = damping_ + (kLoss / w) * loss_;
  return elimination_.factorize(mass_, damping_here_, stiffness_, Complex(0.0, direction_ * w));
}

bool LawBalance::set_speed(double speed) {
  if (speed == speed_ && known_harmonics_ == harmonics_) return true;
  known_harmonics_ = -1;
  const auto& contents = content_->at(direction_ * speed);
  const auto rows = static_cast<Eigen::Index>(inputs_.size()),
             columns = static_cast<Eigen::Index>(terms_.size());
  known_.assign(idx(harmonics_ + 1), Eigen::VectorXcd::Zero(rows));
  compliance_.assign(idx(harmonics_ + 1), Eigen::MatrixXcd::Zero(rows, columns));
  std::vector<Complex> z(idx(system_.size()));
  const auto read = [&](Eigen::Ref<Eigen::VectorXcd> out) {
    for (Eigen::Index i = 0; i < rows; ++i)
      out[i] = value_along(inputs_[static_cast<std::size_t>(i)], z.data());
  };
  for (int n = 0; n <= harmonics_; ++n) {
    if (n > 0 && !stiffness(n, speed)) return false;
    for (Eigen::Index t = -1; t < columns; ++t) {
      std::fill(z.begin(), z.end(), Complex());
      if (t >= 0) {
        for (const Entry& e : terms_[static_cast<std::size_t>(t)].row) z[idx(e.index)] += e.coeff;
      } else {
        for (std::size_t l = 0; l < contents.size(); ++l)
          for (const Entry& e : load_rows_[l])
            z[idx(e.index)] +=
                e.coeff * (n == 0 ? Complex(contents[l].mean) : contents[l].amplitudes[idx(n - 1)]);
      }
      if (n > 0) {
        elimination_.solve(z.data());
      } else {
        Vector p(system_.size());
        for (int i = 0; i < system_.size(); ++i) p[i] = z[idx(i)].real();
        if (t < 0) {
          const Vector drag = direction_ * speed * system_.nominal_drag().head(system_.size());
          if (drag.cwiseAbs().maxCoeff() > kNoBalanceDrag * speed * damping_.cwiseAbs().maxCoeff()) p -= drag;
        }
        mean_->solve(p, nullptr);
        for (int i = 0; i < system_.size(); ++i) z[idx(i)] = p[i];
      }
      read(t < 0 ? Eigen::Ref<Eigen::VectorXcd>(known_[idx(n)]) : compliance_[idx(n)].col(t));
    }
  }
  speed_ = speed;
  known_harmonics_ = harmonics_;
  return true;
}

bool LawBalance::residual(const Vector& x, double speed, Vector& r) {
  if (!set_speed(speed)) return false;
  find_forces(x, speed);
  const Eigen::Index block = 2 * harmonics_ + 1;
  r = x;
  for (int n = 0; n <= harmonics_; ++n) {
    const Eigen::VectorXcd part = known_[idx(n)] - compliance_[idx(n)] * forces_.col(n);
    for (int i = 0; i < inputs(); ++i) {
      const Eigen::Index at = i * block + (n == 0 ? 0 : 2 * n - 1);
      r[at] -= part[i].real();
      if (n > 0) r[at + 1] -= part[i].imag();
    }
  }
  return r.allFinite();
}

const Eigen::MatrixXd& LawBalance::tangent() {
  const Eigen::Index block = 2 * harmonics_ + 1;
  const double w = direction_ * speed_ / turns_;
  tangent_.setIdentity(size(), size());
  Eigen::MatrixXcd lines, slope(harmonics_ + 1, block);
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const Term& term = terms_[t];
    law_slopes_over(t, lines);
    const auto at = [&](int row, int l) { return l < 0 ? std::conj(lines(row, -l)) : lines(row, l); };
    const auto put = [&](int input) {
      for (int n = 0; n <= harmonics_; ++n) {
        for (int i = 0; i < inputs(); ++i) {
          const Complex g = compliance_[idx(n)](i, static_cast<Eigen::Index>(t));
          const Eigen::Index row = i * block + (n == 0 ? 0 : 2 * n - 1);
          tangent_.row(row).segment(input * block, block) += (g * slope.row(n)).real();
          if (n > 0) tangent_.row(row + 1).segment(input * block, block) += (g * slope.row(n)).imag();
        }
      }
    };
    for (const int which : {0, 2}) {
      const int input = which == 0 ? term.x : term.angle;
      if (input < 0) continue;
      for (int m = 0; m <= harmonics_; ++m)
        for (int n = 0; n <= harmonics_; ++n) {
          const Complex rate = which == 0 ? Complex(0.0, n * w) : Complex();
          Complex plus = at(which, m - n) + rate * at(1, m - n),
                  minus = at(which, m + n) - rate * at(1, m + n);
          const double half = m == 0 ? 0.5 : 1.0;
          if (n == 0) {
            slope(m, 0) = (m == 0 ? 1.0 : 2.0) * at(which, m);
          } else {
            slope(m, 2 * n - 1) = half * (plus + minus);
            slope(m, 2 * n) = half * Complex(0.0, 1.0) * (plus - minus);
          }
        }
      if (which == 0)
        for (int m = 0; m <= harmonics_; ++m) {
          if (m == 0) {
            slope(0, 0) -= term.stiffness;
            continue;
          }
          const Complex closed = term.stiffness * Complex(1.0, direction_ * kLoss);
          slope(m, 2 * m - 1) -= closed;
          slope(m, 2 * m) -= Complex(0.0, 1.0) * closed;
        }
      put(input);
    }
  }
  return tangent_;
}

bool LawBalance::speed_slope(const Vector& x, double speed, Vector& r_w) {
  const double step = 1e-5 * speed;
  Vector low, high;
  if (!residual(x, speed - step, low) || !residual(x, speed + step, high)) return false;
  r_w = (high - low) / (2.0 * step);
  return residual(x, speed, low);
}

/// Harmonics E_n of each term's offset e, n = 0..H, by sums over equal parts of the cycle, which suffice for
/// a start.
Eigen::MatrixXcd LawBalance::offset_lines() const {
  Eigen::MatrixXcd lines = Eigen::MatrixXcd::Zero(harmonics_ + 1, static_cast<Eigen::Index>(terms_.size()));
  const int parts = 4 * (harmonics_ + 1);
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (terms_[t].law == nullptr || terms_[t].law->phase_node < 0) continue;
    for (int i = 0; i < parts; ++i) {
      const double psi = kTwoPi * i / parts, e = offset(terms_[t], psi);
      for (int n = 0; n <= harmonics_; ++n)
        lines(n, static_cast<Eigen::Index>(t)) += e * std::polar((n == 0 ? 1.0 : 2.0) / parts, -n * psi);
    }
  }
  return lines;
}

bool LawBalance::linear_start(double speed, Vector& x) {
  if (!set_speed(speed)) return false;
  const Eigen::Index block = 2 * harmonics_ + 1;
  x = Vector::Zero(size());
  const double w = direction_ * speed / turns_;
  const Eigen::MatrixXcd offsets = offset_lines();
  for (int n = 0; n <= harmonics_; ++n) {
    Eigen::VectorXcd here = known_[idx(n)];
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (terms_[t].law == nullptr) continue;
      const auto at = static_cast<Eigen::Index>(t);
      here += Complex(terms_[t].stiffness, n * w * terms_[t].law->force->closed_damping()) * offsets(n, at) *
              compliance_[idx(n)].col(at);
    }
    if (n > 0) {
      Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Identity(inputs(), inputs());
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const Term& term = terms_[t];
        if (term.law == nullptr) continue;
        const Complex left = Complex(0.0, n * w * term.law->force->closed_damping()) -
                             Complex(0.0, direction_ * kLoss * term.stiffness);
        matrix.col(term.x) += left * compliance_[idx(n)].col(static_cast<Eigen::Index>(t));
      }
      here = lu_solve(matrix, here);
    } else {
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const Term& term = terms_[t];
        if (!term.gap) continue;
        const double edge = known_[0][term.x].real() < 0.0 ? term.gap->low : term.gap->high;
        here += term.stiffness * edge * compliance_[0].col(static_cast<Eigen::Index>(t));
      }
    }
    if (!here.allFinite()) return false;
    for (int i = 0; i < inputs(); ++i) {
      const Eigen::Index at = i * block + (n == 0 ? 0 : 2 * n - 1);
      x[at] = here[i].real();
      if (n > 0) x[at + 1] = here[i].imag();
    }
  }
  return true;
}

bool LawBalance::double_harmonics(double speed, Vector& x) {
  const int low = harmonics_;
  Vector r;
  if (!residual(x, speed, r)) return false;
  const LuFactor factor(tangent());
  set_harmonics(2 * low);
  x = resized(x, low, 2 * low);
  const Eigen::Index block = 2 * harmonics_ + 1;
  const double w = direction_ * speed / turns_;
  double first = 0.0, last = 0.0;
  Eigen::MatrixXcd lines;
  for (int k = 0; k < kMostCorrections; ++k) {
    if (!residual(x, speed, r)) return false;
    Vector d = -resized(r, harmonics_, low);
    d = factor.solve(d);
    d = resized(d, low, harmonics_);
    std::vector<Eigen::Vector2cd> mean;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      law_slopes_over(t, lines);
      mean.emplace_back(lines(0, 0), lines(1, 0));
    }
    for (int n = low + 1; n <= harmonics_; ++n) {
      Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Identity(inputs(), inputs());
      for (std::size_t t = 0; t < terms_.size(); ++t)
        matrix.col(terms_[t].x) += (mean[t][0] + Complex(0.0, n * w) * mean[t][1] -
                                    terms_[t].stiffness * Complex(1.0, direction_ * kLoss)) *
                                   compliance_[idx(n)].col(static_cast<Eigen::Index>(t));
      Eigen::VectorXcd right(inputs());
      for (int i = 0; i < inputs(); ++i) right[i] = -line(r, i, n);
      const Eigen::VectorXcd part = lu_solve(matrix, right);
      for (int i = 0; i < inputs(); ++i) {
        d[i * block + 2 * n - 1] = part[i].real();
        d[i * block + 2 * n] = part[i].imag();
      }
    }
    x += d;
    const double size = d.norm();
    if (!std::isfinite(size) || (k > 1 && size > 0.7 * last)) return false;
    if (k == 0) first = size;
    if (size <= kCorrected * first || size <= 1e-13 * x.norm()) return residual(x, speed, r);
    last = size;
  }
  return false;
}

Vector LawBalance::inputs_of(const Vector& z) const {
  Vector values = Vector::Zero(inputs());
  for (int i = 0; i < inputs(); ++i)
    for (const Entry& e : inputs_[idx(i)]) values[i] += e.coeff * z[e.index];
  return values;
}

LawBalance::Complex LawBalance::force_line(std::size_t term, const Vector& x, int n) const {
  const Term& of = terms_[term];
  const Complex closed = of.stiffness * (n == 0 ? Complex(1.0) : Complex(1.0, direction_ * kLoss));
  return forces_(static_cast<Eigen::Index>(term), n) + closed * line(x, of.x, n);
}

bool LawBalance::motion(const Vector& x, double speed, Eigen::MatrixXcd& z) {
  Vector r;
  if (!residual(x, speed, r)) return false;
  const auto& contents = content_->at(direction_ * speed);
  z.setZero(system_.size(), harmonics_ + 1);
  for (int n = 0; n <= harmonics_; ++n) {
    for (std::size_t l = 0; l < contents.size(); ++l)
      for (const Entry& e : load_rows_[l])
        z(e.index, n) += e.coeff * (n == 0 ? Complex(contents[l].mean) : contents[l].amplitudes[idx(n - 1)]);
    for (std::size_t t = 0; t < terms_.size(); ++t)
      for (const Entry& e : terms_[t].row)
        z(e.index, n) -= e.coeff * forces_(static_cast<Eigen::Index>(t), n);
    if (n > 0) {
      if (!stiffness(n, speed)) return false;
      elimination_.solve(z.col(n).data());
      continue;
    }
    Vector p = z.col(0).real();
    const Vector drag = direction_ * speed * system_.nominal_drag().head(system_.size());
    if (drag.cwiseAbs().maxCoeff() > kNoBalanceDrag * speed * damping_.cwiseAbs().maxCoeff()) p -= drag;
    mean_->solve(p, &left_over_);
    z.col(0) = p.cast<Complex>();
  }
  return true;
}

}  // namespace drev
