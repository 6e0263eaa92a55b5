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

ScalarResponse LawBalance::respond(const Term& term, double x, double rate, double angle, double speed,
                                   double psi) const {
  const double phi = turns_ * psi, w = direction_ * speed;
  if (term.law != nullptr) {
    ScalarInput in{.x = x, .x_dot = rate, .t = phi / w};
    if (term.law->phase_node >= 0) {
      const double ratio = system_.ratio(term.law->phase_node);
      const Offset offset = term.law->force->offset(ratio * phi);
      in.x -= offset.e;
      in.x_dot -= offset.de_dangle * ratio * w;
      in.angle = ratio * phi + angle;
    }
    return term.law->force->evaluate(in);
  }
  const double ratio = system_.ratio(term.load->node);
  const LoadInput in{.t = phi / w, .nominal_angle = ratio * phi, .deviation = x, .speed = ratio * w + rate};
  LoadInput rest = in;
  rest.deviation = 0.0;
  rest.speed = ratio * w;
  const LoadResponse here = term.load->load->evaluate(in);
  return {.y = term.load->load->evaluate(rest).torque - here.torque,
          .dy_dx = -here.dtorque_dangle,
          .dy_dx_dot = -here.dtorque_dspeed};
}

ScalarResponse LawBalance::respond(const Term& term, const Vector& x, double speed, double psi) const {
  const Value here = value(x, term.x, speed, psi);
  return respond(term, here.x, here.rate, term.angle < 0 ? 0.0 : value(x, term.angle, speed, psi).x, speed,
                 psi);
}

void LawBalance::add_kinks(const Vector& x, double speed, std::vector<double>& cuts) const {
  const Eigen::Index points = table_.rows(), block = 2 * harmonics_ + 1;
  for (const Term& term : terms_) {
    if (term.kinks.empty()) continue;
    const auto offset = [&](double psi) { return this->offset(term, psi); };
    Vector values = table_ * x.segment(term.x * block, block);
    std::vector<double> at(static_cast<std::size_t>(points));
    for (Eigen::Index i = 0; i < points; ++i) {
      at[static_cast<std::size_t>(i)] = std::atan2(-table_(i, 2), table_(i, 1));
      if (at[static_cast<std::size_t>(i)] < 0.0) at[static_cast<std::size_t>(i)] += kTwoPi;
      values[i] -= offset(at[static_cast<std::size_t>(i)]);
    }
    for (const double kink : term.kinks)
      for (Eigen::Index i = 0; i < points; ++i) {
        const Eigen::Index next = i + 1 < points ? i + 1 : 0;
        double f = values[i] - kink, g = values[next] - kink;
        if ((f < 0.0) == (g < 0.0)) continue;
        // Illinois method between the two points.
        double low = at[static_cast<std::size_t>(i)], high = at[static_cast<std::size_t>(next)];
        if (high < low) high += kTwoPi;
        double root = low;
        for (int k = 0, side = 0; k < 60; ++k) {
          const double last = root;
          root = (low * g - high * f) / (g - f);
          const double h = value(x, term.x, speed, root).x - offset(root) - kink;
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
        cuts.push_back(root < kTwoPi ? root : root - kTwoPi);
      }
  }
}

void LawBalance::add_knots(const Vector& x, double speed, std::vector<double>& cuts) const {
  cuts.insert(cuts.end(), fixed_knots_.begin(), fixed_knots_.end());
  for (const Term& term : terms_) {
    if (term.law == nullptr || term.law->phase_node < 0 || !term.law->varies) continue;
    const double ratio = system_.ratio(term.law->phase_node) * turns_;
    if (ratio == 0.0) continue;
    const double direction = ratio > 0.0 ? 1.0 : -1.0;
    const auto deviation = [&](double psi) {
      return term.angle < 0 ? 0.0 : value(x, term.angle, speed, psi).x;
    };
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

void LawBalance::find_panels(const Vector& x, double speed) {
  std::vector<double> cuts;
  add_kinks(x, speed, cuts);
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
  find_panels(x, speed);
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
          if (term.angle >= 0) angle = value(x, term.angle, speed, psi).x;
        }
        const ScalarResponse r = respond(term, here.x, here.rate, angle, speed, psi);
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
}

}  // namespace drev
