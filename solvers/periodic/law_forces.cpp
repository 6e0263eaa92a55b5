// Forces and slopes of the laws over a cycle, which LawBalance integrates.
#include <drev/core/law/law_force.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/periodic/bracketed_search.hpp"
#include "solvers/periodic/law_balance.hpp"

namespace drev {

void LawBalance::known_knots() {
  for (const Term& term : terms_) {
    if (term.law == nullptr || term.law->phase_node < 0) continue;
    const double ratio = system_.ratio(term.law->phase_node) * turns_;
    if (ratio == 0.0) continue;
    const double direction = ratio > 0.0 ? 1.0 : -1.0;
    for (double angle = 0.0;;) {
      const auto knot = term.law->force->next_offset_knot(angle, direction);
      if (!knot || *knot / ratio >= kTwoPi) break;
      angle = *knot;
      fixed_knots_.push_back(angle / ratio);
    }
  }
}

double LawBalance::offset(const Term& term, double psi) const {
  if (term.law == nullptr || term.law->phase_node < 0) return 0.0;
  return term.law->force->offset(system_.ratio(term.law->phase_node) * turns_ * psi).e;
}

LawBalance::Value LawBalance::value(const Vector& x, int input, double speed, double psi) const {
  const Complex one = std::polar(1.0, psi);
  Complex sum = 0.0, rate = 0.0;
  for (int n = harmonics_; n >= 0; --n) {
    const Complex a = line(x, input, n);
    sum = Complex(sum.real() * one.real() - sum.imag() * one.imag(),
                  sum.real() * one.imag() + sum.imag() * one.real()) +
          a;
    rate = Complex(rate.real() * one.real() - rate.imag() * one.imag(),
                   rate.real() * one.imag() + rate.imag() * one.real()) +
           Complex(-n * a.imag(), n * a.real());
  }
  return {sum.real(), direction_ * speed / turns_ * rate.real()};
}

/// What a law sees where its input is x and its node deviates by `angle`.
ScalarInput LawBalance::law_input(const Term& term, Value x, double angle, double speed, double psi) const {
  const double phi = turns_ * psi, w = direction_ * speed;
  ScalarInput in{.x = x.x, .x_dot = x.rate, .t = phi / w};
  if (term.law->phase_node >= 0) {
    const double ratio = system_.ratio(term.law->phase_node);
    const Offset offset = term.law->force->offset(ratio * phi);
    in.x -= offset.e;
    in.x_dot -= offset.de_dangle * ratio * w;
    in.angle = ratio * phi + angle;
  }
  return in;
}

ScalarResponse LawBalance::respond(const Term& term, Value x, double angle, double speed, double psi) const {
  if (term.law != nullptr) return term.law->force->evaluate(law_input(term, x, angle, speed, psi));
  const double phi = turns_ * psi, w = direction_ * speed;
  const double ratio = system_.ratio(term.load->node);
  const LoadInput in{.t = phi / w,
                     .nominal_angle = ratio * phi,
                     .deviation = x.x,
                     .speed = ratio * w + x.rate,
                     .nominal_speed = ratio * w};
  LoadInput rest = in;
  rest.deviation = 0.0;
  rest.speed = ratio * w;
  const LoadResponse here = term.load->load->evaluate(in);
  return {.y = term.load->load->evaluate(rest).torque - here.torque,
          .dy_dx = -here.dtorque_dangle,
          .dy_dx_dot = -here.dtorque_dspeed};
}

ScalarResponse LawBalance::respond(const Term& term, const Vector& x, double speed, double psi) const {
  return respond(term, value(x, term.x, speed, psi), angle_of(term, x, speed, psi), speed, psi);
}

/// Adds the places psi at which a term meets one of its bounds; values, rates: of the inputs at the points of
/// equal panels.
void LawBalance::add_bounds(const Vector& x, double speed, const Eigen::MatrixXd& values,
                            const Eigen::MatrixXd& rates, std::vector<double>& cuts) {
  const auto points = static_cast<std::size_t>(table_.rows());
  std::vector<double> at(points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    at[i] = std::atan2(-table_(row, 2), table_(row, 1));
    if (at[i] < 0.0) at[i] += kTwoPi;
  }
  std::vector<ScalarInput> inputs(points);
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const Term& term = terms_[t];
    if (term.bounds.empty()) continue;
    const bool scaled = term.law->varies && term.bounds.back().b_v != 0.0;
    // What Y of the pieces sees: the law is s Y(x, x'/s).
    const auto input = [&](Value here, double angle, double psi) {
      ScalarInput in = law_input(term, here, angle, speed, psi);
      if (scaled) in.x_dot /= term.law->force->pieces_scale(in.angle);
      return in;
    };
    for (std::size_t i = 0; i < points; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      inputs[i] = input({values(row, term.x), rates(row, term.x)},
                        scaled && term.angle >= 0 ? values(row, term.angle) : 0.0, at[i]);
    }
    for (const LawBound& bound : term.bounds)
      for (std::size_t i = 0; i < points; ++i) {
        const std::size_t next = i + 1 < points ? i + 1 : 0;
        double f = bound.value(inputs[i].x, inputs[i].x_dot),
               g = bound.value(inputs[next].x, inputs[next].x_dot);
        if ((f < 0.0) == (g < 0.0)) continue;
        // Illinois method between the two points.
        double low = at[i], high = at[next];
        if (high < low) high += kTwoPi;
        double root = low;
        for (int k = 0, side = 0; k < 60; ++k) {
          const double last = root;
          root = (low * g - high * f) / (g - f);
          const ScalarInput in =
              input(value(x, term.x, speed, root), scaled ? angle_of(term, x, speed, root) : 0.0, root);
          const double h = bound.value(in.x, in.x_dot);
          if (h == 0.0 || std::abs(root - last) < 1e-15) break;
          if ((h < 0.0) == (g < 0.0)) {
            high = root, g = h;
            if (side == 1) f *= 0.5;
            side = 1;
          } else {
            low = root, f = h;
            if (side == -1) g *= 0.5;
            side = -1;
          }
        }
        if (root >= kTwoPi) root -= kTwoPi;
        cuts.push_back(root);
        if (bound.in_x_alone()) add_jump(t, bound.kink(), x, speed, root);
      }
  }
}

/// Adds the jump of a term's force at psi, where x crosses a kink, if there is one.
void LawBalance::add_jump(std::size_t term, double kink, const Vector& x, double speed, double psi) {
  constexpr double kBeside = 1e-9;        // distance from the kink over its value, at which the law is called
  constexpr double kJumpRounding = 1e-9;  // jump of the force relative to its terms that is none
  const Term& of = terms_[term];
  const Value here = value(x, of.x, speed, psi);
  const double angle = angle_of(of, x, speed, psi);
  ScalarInput in = law_input(of, here, angle, speed, psi);
  const double rate = std::abs(in.x_dot);
  const double beside = kBeside * std::max(std::abs(kink), rate * turns_ / speed);
  // The force at the kink, by its slope there, from either side.
  const auto from_side = [&](double side, double& size) {
    in.x = kink + side * beside;
    const ScalarResponse r = of.law->force->evaluate(in);
    size += std::abs(r.y) + std::abs(r.dy_dx) * (std::abs(kink) + beside);
    return r.y - side * beside * r.dy_dx;
  };
  double size = 0.0;
  const double jump = from_side(1.0, size) - from_side(-1.0, size);
  if (std::abs(jump) > kJumpRounding * size && rate > 0.0)
    jumps_.push_back({.term = term, .psi = psi, .impulse = jump / rate});
}

void LawBalance::add_knots(const Vector& x, double speed, std::vector<double>& cuts) const {
  cuts.insert(cuts.end(), fixed_knots_.begin(), fixed_knots_.end());
  for (const Term& term : terms_) {
    if (term.law == nullptr || term.law->phase_node < 0 || !term.law->varies) continue;
    const double ratio = system_.ratio(term.law->phase_node) * turns_;
    if (ratio == 0.0) continue;
    const double direction = ratio > 0.0 ? 1.0 : -1.0;
    const auto deviation = [&](double psi) { return angle_of(term, x, speed, psi); };
    double angle = deviation(0.0);
    while (true) {
      const auto knot = term.law->force->next_knot(angle, direction);
      if (!knot) break;
      angle = *knot;
      double psi = angle / ratio;
      for (int k = 0; k < 20 && term.angle >= 0; ++k) {
        const double next = (angle - deviation(psi)) / ratio;
        const bool settled = std::abs(next - psi) < 1e-14;
        psi = next;
        if (settled) break;
      }
      if (psi >= kTwoPi) break;
      if (psi > 0.0) cuts.push_back(psi);
    }
  }
}

void LawBalance::find_panels(const Vector& x, double speed, const Eigen::MatrixXd& values,
                             const Eigen::MatrixXd& rates) {
  std::vector<double> cuts;
  jumps_.clear();
  add_bounds(x, speed, values, rates, cuts);
  add_knots(x, speed, cuts);
  std::sort(cuts.begin(), cuts.end());
  constexpr double kSliver = 1e-13;
  panels_.clear();
  std::size_t next = 0;
  for (int p = 0; p < even_; ++p) {
    double from = kTwoPi / even_ * p;
    const double end = kTwoPi / even_ * (p + 1);
    for (; next < cuts.size() && cuts[next] < end - kSliver; ++next) {
      if (cuts[next] <= from + kSliver) continue;
      panels_.push_back({from, cuts[next]});
      from = cuts[next];
    }
    panels_.push_back({from, end});
  }
  for (Jump& jump : jumps_) {  // one at the end of the cycle is at its beginning
    const auto begins = std::find_if(panels_.begin(), panels_.end(),
                                     [&](const Panel& p) { return p.from >= jump.psi - 2.0 * kSliver; });
    jump.panel = begins == panels_.end() ? 0 : static_cast<std::size_t>(begins - panels_.begin());
  }
}

void LawBalance::find_forces(const Vector& x, double speed) {
  const Eigen::Index block = 2 * harmonics_ + 1, points = table_.rows();
  const auto count = static_cast<Eigen::Index>(terms_.size());
  const double w = direction_ * speed / turns_;
  Eigen::MatrixXd values(points, inputs()), rates(points, inputs());
  for (int i = 0; i < inputs(); ++i) {
    Vector rate = Vector::Zero(block);
    for (int n = 1; n <= harmonics_; ++n) {
      const Complex a = line(x, i, n);
      rate[2 * n - 1] = -n * w * a.imag();
      rate[2 * n] = n * w * a.real();
    }
    values.col(i) = table_ * x.segment(i * block, block);
    rates.col(i) = table_ * rate;
  }
  find_panels(x, speed, values, rates);
  slopes_.resize(panels_.size() * kPoints * terms_.size());
  forces_.setZero(count, harmonics_ + 1);
  heat_.setZero(count);
  closed_ = true;
  std::vector<int> side(terms_.size(), 2);
  struct Least {
    double margin = std::numeric_limits<double>::infinity(), psi = 0.0;
  };
  std::vector<Least> least(terms_.size());  // smallest margin of each closed contact from its gap
  Eigen::MatrixXd weighted = Eigen::MatrixXd::Zero(points, count);  // values at undivided panels
  for (std::size_t p = 0, even = 0; p < panels_.size(); ++p) {
    Panel& panel = panels_[p];
    while (kTwoPi / even_ * static_cast<double>(even + 1) <= panel.from + 1e-14) ++even;
    const double begin = kTwoPi / even_ * static_cast<double>(even),
                 end = kTwoPi / even_ * static_cast<double>(even + 1);
    const bool whole = panel.from == begin && panel.to == end;
    const double half = 0.5 * (panel.to - panel.from);
    panel.constant = true;
    for (int g = 0; g < kPoints; ++g) {
      const int of = g < kPoints / 2 ? kPoints / 2 - 1 - g : g - kPoints / 2;
      const double psi = panel.from + half * (1.0 + (g < kPoints / 2 ? -1.0 : 1.0) * kGaussPoints[idx(of)]);
      const double weight = half * kGaussWeights[idx(of)];
      const Eigen::Index row = static_cast<Eigen::Index>(even) * kPoints + g;
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const Term& term = terms_[t];
        Value here{};
        double angle = 0.0;
        if (whole) {
          here = {values(row, term.x), rates(row, term.x)};
          if (term.angle >= 0) angle = values(row, term.angle);
        } else {
          here = value(x, term.x, speed, psi);
          angle = angle_of(term, x, speed, psi);
        }
        const ScalarResponse r = respond(term, here, angle, speed, psi);
        Slopes& slopes = slopes_[(p * kPoints + idx(g)) * terms_.size() + t];
        slopes = {r.dy_dx, r.dy_dx_dot, term.angle >= 0 ? r.dy_dangle : 0.0};
        panel.constant = panel.constant && slopes == slopes_[p * kPoints * terms_.size() + t];
        heat_[static_cast<Eigen::Index>(t)] += weight * r.dissipated_power / kTwoPi;
        if (term.gap) {
          const double total = here.x - offset(term, psi);
          const int now = total >= term.gap->high ? 1 : total <= term.gap->low ? -1 : 0;
          if (side[t] == 2) side[t] = now;
          closed_ = closed_ && now != 0 && now == side[t];
          const double margin = now > 0 ? total - term.gap->high : term.gap->low - total;
          if (closed_ && margin < least[t].margin) least[t] = {margin, psi};
        }
        if (whole) {
          weighted(row, static_cast<Eigen::Index>(t)) = weight * r.y;
          continue;
        }
        const Complex one = std::polar(1.0, -psi);
        Complex power = weight * r.y / kPi;
        for (int n = 0; n <= harmonics_; ++n, power *= one)
          forces_(static_cast<Eigen::Index>(t), n) += n == 0 ? 0.5 * power : power;
      }
    }
  }
  // A contact may also open between two points.
  for (std::size_t t = 0; t < terms_.size() && closed_; ++t) {
    const Term& term = terms_[t];
    if (!term.gap) continue;
    const double reach = 0.5 * kTwoPi / even_, psi = least[t].psi;
    const BracketedMaximum found =
        bracketed_maximum(psi - reach, psi, psi + reach, 1e-7 * reach, [&](double at) {
          const double total = value(x, term.x, speed, at).x - offset(term, at);
          return side[t] > 0 ? term.gap->high - total : total - term.gap->low;
        });
    closed_ = found.value <= 0.0;
  }
  const Eigen::MatrixXd sums = table_.transpose() * weighted;
  for (Eigen::Index t = 0; t < count; ++t) {
    const Term& term = terms_[static_cast<std::size_t>(t)];
    forces_(t, 0) += sums(0, t) / kTwoPi - term.stiffness * line(x, term.x, 0);
    for (int n = 1; n <= harmonics_; ++n)
      forces_(t, n) += Complex(sums(2 * n - 1, t), sums(2 * n, t)) / kPi -
                       term.stiffness * Complex(1.0, direction_ * kLoss) * line(x, term.x, n);
  }
}

/// Harmonics 1/(2 pi) int slope exp(-i l psi) dpsi, l = 0..2H, of the slopes of a term; rows: x, rate, angle.
void LawBalance::law_slopes_over(std::size_t term, Eigen::MatrixXcd& lines) const {
  const int most = 2 * harmonics_;
  lines.setZero(3, most + 1);
  const auto add = [&](const Slopes& s, double psi, double factor, bool integral) {
    // Adds a jump by s at psi (integrated by parts), or a value at a Gauss point.
    const Complex one = std::polar(1.0, -psi);
    Complex power = factor / kTwoPi;
    for (int l = 0; l <= most; ++l, power *= one) {
      if (integral && l == 0) continue;
      const Complex part = integral ? power / Complex(0.0, static_cast<double>(l)) : power;
      lines(0, l) += s.x * part;
      lines(1, l) += s.rate * part;
      if (s.angle != 0.0) lines(2, l) += s.angle * part;
    }
  };
  const auto slope = [&](std::size_t p) { return panels_[p].constant ? slopes(p, 0, term) : Slopes{}; };
  Slopes before = slope(panels_.size() - 1);
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    const Slopes here = slope(p);
    if (!(here == before))
      add({here.x - before.x, here.rate - before.rate, here.angle - before.angle}, panel.from, 1.0, true);
    before = here;
    const double half = 0.5 * (panel.to - panel.from);
    lines(0, 0) += here.x * half / kPi;
    lines(1, 0) += here.rate * half / kPi;
    lines(2, 0) += here.angle * half / kPi;
    for (int g = 0; !panel.constant && g < kPoints; ++g) {
      const int of = g < kPoints / 2 ? kPoints / 2 - 1 - g : g - kPoints / 2;
      const double psi = panel.from + half * (1.0 + (g < kPoints / 2 ? -1.0 : 1.0) * kGaussPoints[idx(of)]);
      add(slopes(p, g, term), psi, half * kGaussWeights[idx(of)], false);
    }
  }
  for (const Jump& jump : jumps_)
    if (jump.term == term) add({.x = jump.impulse}, jump.psi, speed_ / turns_, false);
}

}  // namespace drev
