#include "solvers/known_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/polynomial.hpp"

namespace drev {

namespace {

constexpr double kOnKnot = 1e-13;  // relative to the angle, at least to 1 rad

std::array<double, 3> over_step(const MotionPoint& m, double h) {
  return {m.value, m.rate * h, 0.5 * m.acceleration * h * h};
}

}  // namespace

KnownForces::KnownForces(const System& system)
    : system_(system), assembler_(system), u_(at(system.prescribed_count())) {
  for (const LoadTerm& term : system.loads()) {
    const NodeMap& map = system.node_map(term.node);
    if (map.unknown < 0) continue;  // its work is the prescribed node's
    const double ratio = system.ratio(term.node);
    const bool feedback = term.load->depends_on_motion();
    if (auto series = term.load->series())
      composed_.push_back(
          {&term, map.unknown, map.coeff, ratio, feedback, std::move(series), {}, {}});
    else
      loads_.push_back({&term, map.unknown, map.coeff, ratio, feedback, {}, 0, 0, 0, 0, 0, 0});
  }
  for (Vector& p : p_) p = Vector::Zero(system.size());
}

void KnownForces::move(double t, const Vector& z, const Vector& v) {
  t_ = t;
  assembler_.set_time(t);
  const MotionPoint& nominal = assembler_.nominal();
  for (Linear& l : loads_) {
    l.deviation = l.feedback ? l.coeff * z[l.row] : 0.0;
    l.angle = l.ratio * nominal.value + l.deviation;
    l.speed = l.ratio * nominal.rate + (l.feedback ? l.coeff * v[l.row] : 0.0);
  }
}

void KnownForces::look_up(Linear& l, double direction) {
  l.stretch = l.term->load->stretch(t_, l.angle, direction).value_or(LoadStretch{});
  l.t_0 = t_;
  l.angle_0 = l.angle;
}

void KnownForces::locate(double t, const Vector& z, const Vector& v) {
  move(t, z, v);
  for (Linear& l : loads_) look_up(l, l.speed);
}

bool KnownForces::advance(double t, const Vector& z, const Vector& v) {
  move(t, z, v);
  bool any = false;
  for (Linear& l : loads_) {
    const double near = kOnKnot * std::max(1.0, std::abs(l.angle));
    if (l.speed > 0.0 ? l.stretch.high - l.angle > near : l.angle - l.stretch.low > near) continue;
    look_up(l, l.speed);
    any = true;
  }
  return any;
}

void KnownForces::pass_knot() { look_up(loads_[at(leaving_)], leaving_direction_); }

double KnownForces::time_to_knot() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Linear& l : loads_) {
    if (l.speed > 0.0) least = std::min(least, (l.stretch.high - l.angle) / l.speed);
    if (l.speed < 0.0) least = std::min(least, (l.stretch.low - l.angle) / l.speed);
  }
  return least;
}

void KnownForces::add_to(TaylorSeries& series, double h) {
  const int n = system_.size();
  for (Vector& p : p_) p.setZero();
  const MotionPoint& nominal = assembler_.nominal();
  phi_ = over_step(nominal, h);
  if (nominal.acceleration != 0.0)
    p_[0] -= nominal.acceleration * system_.nominal_inertia().head(n);
  if (nominal.rate != 0.0) p_[0] -= nominal.rate * system_.nominal_drag().head(n);
  if (nominal.acceleration != 0.0)
    p_[1] -= (nominal.acceleration * h) * system_.nominal_drag().head(n);
  if (system_.any_prescribed_moves()) {
    const MatrixSet& zu = system_.coupling_zu();
    for (int k = 0; k < system_.prescribed_count(); ++k) {
      const MotionPoint& u = assembler_.prescribed(k);
      u_[at(k)] = over_step(u, h);
      for (SparseMatrix::InnerIterator it(zu.mass, k); it; ++it)
        p_[0][it.row()] -= it.value() * u.acceleration;
      for (SparseMatrix::InnerIterator it(zu.damping, k); it; ++it) {
        p_[0][it.row()] -= it.value() * u.rate;
        p_[1][it.row()] -= it.value() * u.acceleration * h;
      }
      for (SparseMatrix::InnerIterator it(zu.stiffness, k); it; ++it)
        for (std::size_t i = 0; i < 3; ++i) p_[i][it.row()] -= it.value() * u_[at(k)][i];
    }
  }
  for (Linear& l : loads_) {
    const LoadStretch& s = l.stretch;
    l.torque = s.torque + s.time_slope * (t_ - l.t_0) + s.angle_slope * (l.angle - l.angle_0);
    p_[0][l.row] += l.coeff * l.torque;
    p_[1][l.row] += l.coeff * (s.time_slope * h + s.angle_slope * l.ratio * phi_[1]);
    p_[2][l.row] += l.coeff * s.angle_slope * l.ratio * phi_[2];
  }
  for (std::size_t i = 0; i < 3; ++i) series.right_side()[i] += p_[i];
  for (const Linear& l : loads_) {
    if (!l.feedback || l.stretch.angle_slope == 0.0) continue;
    const double slope = l.coeff * l.coeff * l.stretch.angle_slope;
    series.add_stiffness(l.term->slot, -slope);
    // The slope acts on the change of the deviation over the step.
    series.right_side()[0][l.row] -= l.coeff * l.stretch.angle_slope * l.deviation;
  }
}

void KnownForces::add(int k, const double* z, double* rhs) {
  const std::ptrdiff_t n = system_.size();
  for (Composed& c : composed_) {
    if (k == 0) c.angle.clear(), c.torque.clear();
    double angle = k < 3 ? c.ratio * phi_[at(k)] : 0.0;
    if (c.feedback) angle += c.coeff * z[k * n + c.row];
    c.angle.push_back(angle);
    c.torque.push_back(c.series->coefficient(k, c.angle));
    rhs[c.row] += c.coeff * c.torque.back();
  }
}

void KnownForces::shorten(double r) {
  double power = 1.0;
  for (std::size_t i = 0; i < 3; ++i, power *= r) {
    p_[i] *= power;
    phi_[i] *= power;
    for (auto& u : u_) u[i] *= power;
  }
  for (Composed& c : composed_) {
    power = 1.0;
    for (double& t : c.torque) t *= power, power *= r;
  }
}

std::optional<double> KnownForces::first_knot(const TaylorSeries& series, double end) {
  leaving_ = -1;
  std::optional<double> first;
  const auto degree = static_cast<std::size_t>(series.degree());
  theta_.resize(degree + 1);
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const Linear& l = loads_[i];
    if (std::isinf(l.stretch.low) && std::isinf(l.stretch.high)) continue;
    double rest = 0.0;
    for (std::size_t k = 1; k <= degree; ++k) {
      theta_[k] = k < 3 ? l.ratio * phi_[k] : 0.0;
      if (l.feedback)
        theta_[k] += l.coeff * series.coefficients()[k * static_cast<std::size_t>(series.size()) +
                                                     static_cast<std::size_t>(l.row)];
      if (k > 1) rest += static_cast<double>(k) * std::abs(theta_[k]);
    }
    for (const double side : {1.0, -1.0}) {
      const double bound = side > 0.0 ? l.stretch.high : l.stretch.low;
      if (side * theta_[1] < 0.0 && std::abs(theta_[1]) > rest) continue;  // it moves away
      const double distance = std::max(0.0, side * (bound - l.angle));
      const double far = (std::abs(theta_[1]) + rest) * end;
      if (distance > far) continue;
      theta_[0] = distance;
      std::vector<double>& g = power_;
      g.assign(1, distance);
      for (std::size_t k = 1; k <= degree; ++k) g.push_back(-side * theta_[k]);
      std::size_t lead = 0;
      while (lead <= degree && g[lead] == 0.0) ++lead;
      if (lead > degree) continue;
      const std::optional<double> s = g[lead] < 0.0 ? std::optional(0.0) : first_crossing(g, end);
      if (!s) continue;
      first = s;
      end = *s;
      leaving_ = static_cast<int>(i);
      leaving_direction_ = side;
    }
  }
  return first;
}

double KnownForces::work(const TaylorSeries& series, double s) {
  // int p z' ds with p of degree 2: moments of z'; the slopes' part is a difference of squares.
  const int n = series.size();
  i0_.setZero(n);
  i1_.setZero(n);
  i2_.setZero(n);
  double power = s;
  for (int k = 1; k <= series.degree(); ++k, power *= s) {
    const Eigen::Map<const Vector> z(series.coefficients() + static_cast<std::ptrdiff_t>(k) * n, n);
    i0_ += power * z;
    i1_ += (power * s * k / (k + 1)) * z;
    i2_ += (power * s * s * k / (k + 2)) * z;
  }
  double sum = p_[0].dot(i0_) + p_[1].dot(i1_) + p_[2].dot(i2_);
  for (const Linear& l : loads_)
    if (l.feedback) {
      const double turn = l.coeff * i0_[l.row];
      sum += 0.5 * l.stretch.angle_slope * turn * turn;
    }
  for (const Composed& c : composed_) {
    double s_j = 1.0;
    for (std::size_t j = 0; j < c.torque.size(); ++j, s_j *= s) {
      double s_k = s_j * s;
      for (int k = 1; k <= series.degree(); ++k, s_k *= s)
        sum += c.coeff * c.torque[j] * k / (static_cast<double>(j) + k) * s_k *
               series.coefficients()[static_cast<std::ptrdiff_t>(k) * n + c.row];
    }
  }
  return sum;
}

}  // namespace drev
