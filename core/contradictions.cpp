#include "core/contradictions.hpp"

#include <drev/core/error.hpp>
#include <drev/core/law/piecewise_law.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drev {

namespace {

constexpr double kAgree = 1e-9;  // relative to the size of the terms
constexpr double kNear = 1e-6;   // beside a bound: of the range, or of its own place
constexpr double kParts[] = {kNear, 0.1, 0.4, 0.8, 1.0 - kNear};

/// The point at a part f of a range, 0 < f < 1; an infinite side is entered by the scale of the other one.
double inside(const Interval& r, double f) {
  const double beyond = f / (1.0 - f), before = (1.0 - f) / f;
  const bool low = std::isfinite(r.low), high = std::isfinite(r.high);
  if (low && high) return r.low + f * (r.high - r.low);
  if (low) return r.low + (r.low != 0.0 ? std::abs(r.low) : 1.0) * beyond;
  if (high) return r.high - (r.high != 0.0 ? std::abs(r.high) : 1.0) * before;
  return beyond - before;
}

bool agree(double a, double b, double size) { return std::abs(a - b) <= kAgree * size; }

std::string where(const ScalarInput& in) {
  return " at x = " + to_text(in.x) + ", x_dot = " + to_text(in.x_dot);
}

/// Each quantity of a piece, and the size of the terms that it is summed from.
struct Quantity {
  const char* name;
  double ScalarResponse::*of;
  double value, size;
};

std::array<Quantity, 4> quantities(const LawPiece& p, double x, double x_dot) {
  const double y = p.force(x, x_dot), elastic = p.elastic_0 + p.elastic_k * x;
  const double damper = std::abs(p.c) + std::abs(p.product * x);
  const double size = std::abs(p.y_0) + std::abs(p.k * x) + damper * std::abs(x_dot);
  const double of_both = size + std::abs(p.elastic_0) + std::abs(p.elastic_k * x);
  return {{{"y", &ScalarResponse::y, y, size},
           {"dy_dx", &ScalarResponse::dy_dx, p.k + p.product * x_dot,
            std::abs(p.k) + std::abs(p.product * x_dot)},
           {"dy_dx_dot", &ScalarResponse::dy_dx_dot, p.c + p.product * x, damper},
           {"dissipated_power", &ScalarResponse::dissipated_power, (y - elastic) * x_dot,
            of_both * std::abs(x_dot)}}};
}

/// The first quantity in which a piece and the call's response differ.
std::optional<Contradiction> compare(const LawPiece& piece, int number, const ScalarResponse& called,
                                     const ScalarInput& in) {
  for (const Quantity& q : quantities(piece, in.x, in.x_dot))
    if (!agree(called.*q.of, q.value, q.size))
      return Contradiction{"pieces", "piece " + std::to_string(number) + " gives " + q.name + " = " +
                                         to_text(q.value) + ", the call " + to_text(called.*q.of) +
                                         where(in)};
  return std::nullopt;
}

std::optional<Contradiction> wrong_next(std::span<const LawPiece> pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (const LawBound& b : pieces[i].bounds)
      if (b.next < 0 || b.next >= static_cast<int>(pieces.size()) || b.next == static_cast<int>(i))
        return Contradiction{"pieces", "a bound of piece " + std::to_string(i) + " leads to piece " +
                                           std::to_string(b.next) + ", which is none of the other pieces"};
  return std::nullopt;
}

/// Calls f(input) at points inside a piece.
template <class F>
void inside_piece(const LawPiece& piece, std::span<const double> x_parts, std::span<const double> rate_parts,
                  const F& f) {
  const Interval x_range = piece.x_range();
  for (const double part : x_parts) {
    const double x = inside(x_range, part);
    const Interval rates = piece.rate_range(x);
    for (const double rate_part : rate_parts) {
      const double x_dot = inside(rates, rate_part);
      if (x > x_range.low && x < x_range.high && x_dot > rates.low && x_dot < rates.high)
        f(ScalarInput{.x = x, .x_dot = x_dot});
    }
  }
}

/// The pieces of a law that states any, as they are at an angle.
std::vector<LawPiece> pieces_at(const ScalarForce& law, double angle) {
  const std::span<const LawPiece> pieces = law.pieces();
  return PiecewiseLaw({pieces.begin(), pieces.end()}).scaled(law.pieces_scale(angle));
}

/// The pieces of a law at an angle against its call.
class PieceComparison {
 public:
  PieceComparison(const ScalarForce& law, double angle, std::vector<Contradiction>& found)
      : law_(law),
        pieces_(pieces_at(law, angle)),
        derived_(pieces_),
        found_(found),
        energy_constant_(law.evaluate({.angle = angle}).stored_energy -
                         derived_.evaluate(0.0, 0.0).stored_energy) {}

  void at(const ScalarInput& in) {
    const auto holding = std::count_if(pieces_.begin(), pieces_.end(),
                                       [&](const LawPiece& p) { return p.holds(in.x, in.x_dot); });
    if (holding > 1 || (holding == 0 && !on_a_bound(in)))
      found_.push_back({"pieces", std::to_string(holding) + " of them hold" + where(in) +
                                      "; exactly one must, but on bounds"});
    if (holding != 1) return;
    const ScalarResponse called = law_.evaluate(in);
    const int number = piece_at(pieces_, in.x, in.x_dot);
    if (auto wrong = compare(pieces_[static_cast<std::size_t>(number)], number, called, in))
      found_.push_back(std::move(*wrong));
    compare_energy(called, number, in);
  }
  void kinks();
  void gap();
  void closed_slopes();

 private:
  bool on_a_bound(const ScalarInput& in) const {
    const auto zero = [&](const LawBound& b) {
      return std::abs(b.value(in.x, in.x_dot)) <=
             kAgree * (std::abs(b.a) + std::abs(b.b_x * in.x) + std::abs(b.b_v * in.x_dot));
    };
    return std::any_of(pieces_.begin(), pieces_.end(), [&](const LawPiece& p) {
      return std::any_of(p.bounds.begin(), p.bounds.end(), zero);
    });
  }
  /// The law's energy may differ from that of the pieces by a constant.
  void compare_energy(const ScalarResponse& called, int number, const ScalarInput& in) {
    const double own = derived_.evaluate(in.x, in.x_dot).stored_energy;
    const double expected = own + energy_constant_,
                 size = std::abs(own) + std::abs(energy_constant_) + called.stored_energy;
    if (!agree(called.stored_energy, expected, size))
      found_.push_back({"pieces", "piece " + std::to_string(number) +
                                      " gives stored_energy = " + to_text(expected) + ", the call " +
                                      to_text(called.stored_energy) + where(in)});
  }

  const ScalarForce& law_;
  std::vector<LawPiece> pieces_;
  PiecewiseLaw derived_;
  std::vector<Contradiction>& found_;
  double energy_constant_ = 0.0;
};

bool has(std::span<const double> kinks, double kink) {
  return std::any_of(kinks.begin(), kinks.end(),
                     [&](double k) { return agree(k, kink, std::abs(k) + std::abs(kink)); });
}

void PieceComparison::kinks() {
  const std::span<const double> own = derived_.kinks(), told = law_.kinks();
  for (const double kink : own)
    if (!has(told, kink))
      found_.push_back({"kinks", "none is told at x = " + to_text(kink) + ", where the pieces have a bound"});
  for (const double kink : told)
    if (!has(own, kink))
      found_.push_back({"kinks", "one is told at x = " + to_text(kink) + ", where no piece has a bound"});
}

std::string text(const std::optional<Gap>& gap) {
  return gap ? to_text(gap->low) + " to " + to_text(gap->high) : "none";
}

void PieceComparison::gap() {
  const std::optional<Gap> own = derived_.gap(), told = law_.gap();
  const auto same = [](double a, double b) { return a == b || agree(a, b, std::abs(a) + std::abs(b)); };
  if (own.has_value() == told.has_value() &&
      (!own || (same(own->low, told->low) && same(own->high, told->high))))
    return;
  found_.push_back({"gap", "the pieces have " + text(own) + ", told is " + text(told)});
}

/// They must lie among those of the pieces that carry elastic force.
void PieceComparison::closed_slopes() {
  const auto check = [&](const char* name, double told, double LawPiece::*of) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const LawPiece& p : law_.pieces()) {
      if (p.product != 0.0 && of == &LawPiece::c) continue;
      low = std::min(low, p.*of);
      high = std::max(high, p.*of);
    }
    const double size = kAgree * std::max(std::abs(low), std::abs(high));
    if (told < low - size || told > high + size)
      found_.push_back(
          {name, to_text(told) + " is told, the pieces have " + to_text(low) + " to " + to_text(high)});
  };
  check("closed_stiffness", law_.closed_stiffness(), &LawPiece::k);
  check("closed_damping", law_.closed_damping(), &LawPiece::c);
}

/// No elastic force in the gap, some beyond it.
void compare_gap(const ScalarForce& law, std::vector<Contradiction>& found) {
  const std::optional<Gap> gap = law.gap();
  if (!gap || !(gap->low < gap->high)) return;
  for (const double part : kParts) {
    const ScalarInput in{.x = inside({gap->low, gap->high}, part)};
    if (const double y = law.evaluate(in).y; y != 0.0)
      found.push_back({"gap", "the call gives y = " + to_text(y) + " inside it" + where(in)});
  }
  for (const Interval& side : {Interval{.high = gap->low}, Interval{.low = gap->high}}) {
    if (std::isinf(side.low) && std::isinf(side.high)) continue;
    if (side.low == side.high) continue;
    const bool front = std::isfinite(side.low);
    const ScalarInput in{.x = inside(side, front ? 1e-3 : 1.0 - 1e-3)};
    if (law.evaluate(in).y == 0.0) found.push_back({"gap", "the call gives y = 0 beyond it" + where(in)});
  }
}

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
    const double reach = std::max(1.0, std::abs(angle));
    for (const double part : kParts) {
      LoadInput other = in;
      const Interval range{std::max(s.low, angle - reach), std::min(s.high, angle + reach)};
      const double moved = inside(range, part) - angle;
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
        found.push_back({"stretch", "is told at t = 0, angle = 0 or" + where(in) + ", but not at both"});
      else if (s)
        StretchComparison(load, "stretch", found).at(in, *s, next_break);
    }
  }
}

}  // namespace

std::optional<Contradiction> first_contradiction(const ScalarForce& law) {
  if (law.pieces().empty()) return std::nullopt;
  const std::vector<LawPiece> pieces = pieces_at(law, 0.0);
  std::optional<Contradiction> found = wrong_next(pieces);
  constexpr double x_part[] = {0.4}, rate_part[] = {0.8};
  for (std::size_t i = 0; i < pieces.size() && !found; ++i)
    inside_piece(pieces[i], x_part, rate_part, [&](const ScalarInput& in) {
      found = compare(pieces[i], static_cast<int>(i), law.evaluate(in), in);
    });
  return found;
}

std::optional<Contradiction> first_contradiction(const Load& load) {
  if (!load.stretch(0.0, 0.0, 1.0)) return std::nullopt;
  std::vector<Contradiction> found;
  const LoadInput in[] = {{.t = 0.0, .nominal_angle = 1.0}};
  compare_load(load, in, found);
  if (found.empty()) return std::nullopt;
  return found.front();
}

std::vector<Contradiction> contradictions(const ScalarForce& law, std::span<const ScalarInput> at) {
  std::vector<Contradiction> found;
  compare_gap(law, found);
  const std::span<const LawPiece> pieces = law.pieces();
  if (pieces.empty()) return found;
  if (auto wrong = wrong_next(pieces)) return {*wrong};
  PieceComparison comparison(law, 0.0, found);
  for (const LawPiece& p : pieces_at(law, 0.0))
    inside_piece(p, kParts, kParts, [&](const ScalarInput& in) { comparison.at(in); });
  for (const ScalarInput& in : at) PieceComparison(law, in.angle, found).at(in);
  comparison.kinks();
  comparison.gap();
  comparison.closed_slopes();
  return found;
}

std::vector<Contradiction> contradictions(const Load& load, std::span<const LoadInput> at) {
  std::vector<Contradiction> found;
  if (const auto table = load.table())
    if (const std::string fault = table->fault(); !fault.empty()) return {{"table", fault}};
  compare_load(load, at, found);
  return found;
}

}  // namespace drev
