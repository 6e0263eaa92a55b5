// What a load says of itself twice, compared with its call (contradictions.hpp).
#include <drev/core/error.hpp>
#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contradictions.hpp"
#include "core/dense/factorization.hpp"
#include "core/law/agreement.hpp"

namespace drev {

namespace {

std::string where(const LoadInput& in) {
  return " at t = " + to_text(in.t) + ", angle = " + to_text(in.nominal_angle + in.deviation);
}

double angle_of(const Load& load, const LoadInput& in) {
  return in.nominal_angle + (load.depends_on_motion() ? in.deviation : 0.0);
}

/// A stretch about an input, or one of the load's table, against the call at the input and at its ends.
class StretchComparison {
 public:
  StretchComparison(const Load& load, const char* what, std::vector<Contradiction>& found)
      : load_(load), what_(what), found_(found) {}

  void at(const LoadInput& in, const LoadStretch& s, double next_break) {
    const double angle = angle_of(load_, in), near = kAgree * std::max(1.0, std::abs(angle));
    if (!(s.low <= angle + near && s.high >= angle - near))
      return add("reaches from " + to_text(s.low) + " to " + to_text(s.high), in);
    for (const double part : kPartsOfRange) {
      LoadInput other = in;
      const double moved = inside(near_angle(s.low, s.high, angle), part) - angle;
      other.nominal_angle += moved;
      const double later = std::isfinite(next_break) ? part * (next_break - in.t) : part;
      other.t += later;
      compare(s, other, moved, later);
    }
    compare(s, in, 0.0, 0.0);
  }

 private:
  void compare(const LoadStretch& s, const LoadInput& in, double moved, double later) {
    const double expected = s.torque + s.time_slope * later + s.angle_slope * moved;
    const double called = load_.evaluate(in).torque;
    // Rounding of the angle and of the time comes in with the slopes.
    const double size = std::abs(s.torque) + std::abs(expected) +
                        std::abs(s.angle_slope) * std::max(1.0, std::abs(in.nominal_angle)) +
                        std::abs(s.time_slope) * std::max(1.0, std::abs(in.t));
    if (!agree(called, expected, size))
      add("gives a torque of " + to_text(expected) + ", the call " + to_text(called), in);
  }
  void add(const std::string& text, const LoadInput& in) { found_.push_back({what_, text + where(in)}); }

  const Load& load_;
  const char* what_;
  std::vector<Contradiction>& found_;
};

void compare_load(const Load& load, std::span<const LoadInput> at, std::vector<Contradiction>& found) {
  const std::optional<LoadTable> table = load.table();
  std::vector<double> breaks = load.breakpoints();
  std::sort(breaks.begin(), breaks.end());
  const bool stretches = load.stretch(0.0, 0.0, 1.0).has_value();
  for (const LoadInput& in : at) {
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), in.t);
    const double next_break = next == breaks.end() ? std::numeric_limits<double>::infinity() : *next;
    for (const double direction : {1.0, -1.0}) {
      const double angle = angle_of(load, in);
      if (table) StretchComparison(load, "table", found).at(in, table->stretch(angle, direction), next_break);
      const std::optional<LoadStretch> s = load.stretch(in.t, angle, direction);
      if (s.has_value() != stretches)
        found.push_back({"stretch", "is stated at t = 0, angle = 0 or" + where(in) + ", but not at both"});
      else if (s)
        StretchComparison(load, "stretch", found).at(in, *s, next_break);
    }
  }
}

/// Something a load says besides its call, against that call.
class FormComparison {
 public:
  FormComparison(const Load& load, const LoadInput& in, std::vector<Contradiction>& found)
      : load_(load), in_(in), angle_(angle_of(load, in)), found_(found) {}

  void harmonics(const HarmonicLoad& stated) {
    const LoadOrders orders = stated.orders();
    const LoadResponse told = orders.at(angle_), called = load_.evaluate(in_);
    double size = std::abs(orders.mean), slope_size = 0.0;
    for (const LoadOrder& o : orders.terms) {
      const double amplitude =
          (std::abs(o.cosine) + std::abs(o.sine)) * (1.0 + 1e-6 * o.order * std::abs(angle_));
      size += amplitude;
      slope_size += o.order * amplitude;
    }
    compare("orders", "torque", told.torque, called.torque, size, in_);
    if (load_.depends_on_motion())
      compare("orders", "dtorque_dangle", told.dtorque_dangle, called.dtorque_dangle, slope_size, in_);
  }

  void knots(const KnottedLoad& stated) {
    const bool follows = load_.depends_on_motion();
    const double speed = follows ? in_.speed : in_.nominal_speed;
    for (const double direction : {1.0, -1.0}) {
      const CubicPiece p = stated.piece(angle_, direction, in_.nominal_speed);
      const double near = kAgree * std::max(1.0, std::abs(angle_));
      if (!(p.low <= angle_ + near && p.high >= angle_ - near)) {
        add("piece", "reaches from " + to_text(p.low) + " to " + to_text(p.high), in_);
        continue;
      }
      if (stated.turns() == 0) continue;
      for (const double part : kPartsOfRange) {
        LoadInput other = in_;
        const double moved = inside(near_angle(p.low, p.high, angle_), part) - angle_;
        other.nominal_angle += moved;
        const KnottedLoad::Curves c = stated.curves(angle_ + moved);
        double cubic = 0.0, steep = 0.0, size = 0.0, power = 1.0;
        for (std::size_t k = 0; k < p.terms.size(); ++k, power *= moved) {
          cubic += p.terms[k] * power;
          size += std::abs(p.terms[k] * power);
          if (k + 1 < p.terms.size()) steep += static_cast<double>(k + 1) * std::abs(p.terms[k + 1] * power);
        }
        const double by_speed = c.by_speed_squared * speed * speed;
        // Rounding of the angle comes in with the slopes: of the cubic, and of curves that pass through zero.
        const KnottedLoad::Curves beside = stated.curves(angle_ + moved + 0.1);
        const double factor = std::max(std::abs(c.factor), std::abs(beside.factor));
        const double square = std::max(std::abs(c.by_speed_squared), std::abs(beside.by_speed_squared));
        size = (size + steep * std::max(1.0, std::abs(angle_))) * factor + square * speed * speed;
        const double called = load_.evaluate(other).torque;
        compare("piece", "torque", cubic * c.factor + by_speed, called, size + std::abs(called), other);
        const KnottedLoad::Curves later = stated.curves(angle_ + moved + stated.turns() * kTwoPi);
        repeats("factor", c.factor, later.factor, factor, other);
        repeats("by_speed_squared", c.by_speed_squared, later.by_speed_squared, square, other);
      }
    }
  }

  /// Bounds of the slopes over ranges about the input, against the slopes in its middle and between its ends.
  void slopes() {
    const bool follows = load_.depends_on_motion();
    const LoadResponse r = load_.evaluate(in_);
    const std::vector<double> breaks = load_.breakpoints();
    for (const double wide : {0.0, 1e-3, 1.0}) {
      const LoadRanges over{.t = {in_.t, in_.t + wide},
                            .angle = {angle_ - wide, angle_ + wide},
                            .speed = {in_.speed - wide, in_.speed + wide},
                            .nominal_speed = {in_.nominal_speed, in_.nominal_speed}};
      const std::optional<LoadSlopes> bounds = load_.steepest(over);
      if (!bounds) return;
      LoadInput later = in_;
      later.t += wide;
      const auto exceeds = [&](const char* what, double bound, double slope, double rounding) {
        if (!(std::abs(slope) <= bound + kAgree * std::abs(slope) + rounding))
          add("steepest",
              std::string("bounds ") + what + " by " + to_text(bound) + ", the call has " + to_text(slope),
              in_);
      };
      if (follows) exceeds("dtorque_dangle", bounds->by_angle, r.dtorque_dangle, 0.0);
      if (follows) exceeds("dtorque_dspeed", bounds->by_speed, r.dtorque_dspeed, 0.0);
      const bool jumps =
          std::any_of(breaks.begin(), breaks.end(), [&](double t) { return t >= in_.t && t <= later.t; });
      const double rise = load_.evaluate(later).torque - r.torque;
      if (wide > 0.0 && !jumps)
        exceeds("the slope by the time", bounds->by_time, rise / wide, kAgree * std::abs(r.torque) / wide);
    }
  }

  /// At a steady speed.
  void scaled_by_speed(const SpeedScaledLoad& stated) {
    const LoadInput steady{
        .t = in_.t, .nominal_angle = in_.nominal_angle, .speed = in_.speed, .nominal_speed = in_.speed};
    const std::vector<double> factors = stated.speed_factors(in_.speed);
    double told = 0.0, size = 0.0;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const double term = factors[k] * stated.curve(static_cast<int>(k), in_.nominal_angle);
      told += term;
      size += std::abs(term);
    }
    compare("speed_factors", "torque", told, load_.evaluate(steady).torque, size, steady);
  }

 private:
  static constexpr double kRepeats = 1e-7;  // of the curve's size a period later: rounding of the angle
  void repeats(const char* curve, double here, double later, double size, const LoadInput& in) {
    if (std::abs(here - later) > kRepeats * size)
      add("curves", std::string(curve) + " is " + to_text(here) + ", " + to_text(later) + " a period later",
          in);
  }
  void compare(const char* what, const char* quantity, double told, double called, double size,
               const LoadInput& in) {
    if (!agree(told, called, size))
      add(what, std::string("gives ") + quantity + " = " + to_text(told) + ", the call " + to_text(called),
          in);
  }
  void add(const char* what, const std::string& text, const LoadInput& in) {
    found_.push_back({what, text + where(in) + ", speed = " + to_text(in.speed)});
  }

  const Load& load_;
  const LoadInput& in_;
  double angle_;
  std::vector<Contradiction>& found_;
};

/// A load that states frequencies is a mean and harmonics of these: what is left of a fit by least squares.
void compare_frequencies(const Load& load, std::span<const LoadInput> at, std::vector<Contradiction>& found) {
  constexpr std::size_t kMostFrequencies = 40;
  const std::vector<double> frequencies = load.frequencies();
  if (frequencies.empty() || frequencies.size() > kMostFrequencies || at.size() < 6 * frequencies.size() + 6)
    return;
  const auto rows = static_cast<Eigen::Index>(at.size()),
             terms = static_cast<Eigen::Index>(frequencies.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Ones(rows, 2 * terms + 1);
  Eigen::VectorXd torque(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LoadInput& in = at[static_cast<std::size_t>(i)];
    torque[i] = load.evaluate({.t = in.t}).torque;
    for (Eigen::Index j = 0; j < terms; ++j) {
      const double phase = kTwoPi * frequencies[static_cast<std::size_t>(j)] * in.t;
      a(i, 2 * j + 1) = std::cos(phase);
      a(i, 2 * j + 2) = std::sin(phase);
    }
  }
  const Eigen::VectorXd left = torque - a * least_squares(a, torque);
  if (left.cwiseAbs().maxCoeff() > 1e-6 * torque.cwiseAbs().maxCoeff())
    found.push_back({"frequencies", "leave " + to_text(left.cwiseAbs().maxCoeff()) + " N m of a torque of " +
                                        to_text(torque.cwiseAbs().maxCoeff()) + " N m"});
}

}  // namespace

std::optional<Contradiction> first_contradiction(const Load& load) {
  if (!load.stretch(0.0, 0.0, 1.0)) return std::nullopt;
  std::vector<Contradiction> found;
  const LoadInput in[] = {{.t = 0.0, .nominal_angle = 1.0}};
  compare_load(load, in, found);
  if (found.empty()) return std::nullopt;
  return found.front();
}

std::vector<Contradiction> contradictions(const Load& load, std::span<const LoadInput> at) {
  std::vector<Contradiction> found;
  if (const auto table = load.table())
    if (const std::string fault = table->fault(); !fault.empty()) return {{"table", fault}};
  compare_load(load, at, found);
  for (const LoadInput& in : at) {
    FormComparison forms(load, in, found);
    forms.slopes();
    if (const auto* stated = dynamic_cast<const HarmonicLoad*>(&load)) forms.harmonics(*stated);
    if (const auto* stated = dynamic_cast<const KnottedLoad*>(&load)) forms.knots(*stated);
    if (const auto* stated = dynamic_cast<const SpeedScaledLoad*>(&load)) forms.scaled_by_speed(*stated);
  }
  compare_frequencies(load, at, found);
  return found;
}

}  // namespace drev
