#include "core/contradictions.hpp"

#include <drev/core/error.hpp>
#include <drev/core/law/angle_scaled_force.hpp>
#include <drev/core/law/piecewise_law.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/element_parts.hpp"
#include "core/law/agreement.hpp"

namespace drev {

namespace {

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
    const LawPiece& piece = pieces_[static_cast<std::size_t>(number)];
    const double expected = own + energy_constant_,
                 of_rounding =
                     std::abs((piece.elastic_0 + piece.elastic_k * in.x) * in.x),  // of x and of bounds
        size = std::abs(own) + std::abs(energy_constant_) + called.stored_energy + of_rounding;
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
      found_.push_back(
          {"kinks", "none is stated at x = " + to_text(kink) + ", where the pieces have a bound"});
  for (const double kink : told)
    if (!has(own, kink))
      found_.push_back({"kinks", "one is stated at x = " + to_text(kink) + ", where no piece has a bound"});
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
  found_.push_back({"gap", "the pieces have " + text(own) + ", stated is " + text(told)});
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
          {name, to_text(told) + " is stated, the pieces have " + to_text(low) + " to " + to_text(high)});
  };
  check("closed_stiffness", law_.closed_stiffness(), &LawPiece::k);
  check("closed_damping", law_.closed_damping(), &LawPiece::c);
}

/// No elastic force in the gap, some beyond it.
void compare_gap(const ScalarForce& law, std::vector<Contradiction>& found) {
  const std::optional<Gap> gap = law.gap();
  if (!gap || !(gap->low < gap->high)) return;
  for (const double part : kPartsOfRange) {
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

/// The formula of a law's scale about an angle against the scale itself.
void compare_scale(const ScalarForce& law, const AngleScaledForce& stated, double angle,
                   std::vector<Contradiction>& found) {
  for (const double direction : {1.0, -1.0}) {
    const ScaleStretch s = stated.scale_stretch(angle, direction);
    const auto add = [&](const std::string& text) {
      found.push_back({"scale_stretch", text + " at an angle of " + to_text(angle) + " rad"});
    };
    const double near = kAgree * std::max(1.0, std::abs(angle));
    if (!(s.low <= angle + near && s.high >= angle - near)) {
      add("reaches from " + to_text(s.low) + " to " + to_text(s.high));
      continue;
    }
    for (const double part : kPartsOfRange) {
      const double at = inside(near_angle(s.low, s.high, angle), part), told = law.pieces_scale(at);
      double scale = s.value + s.slope * (at - angle);
      double size = std::abs(told) + std::abs(s.slope) * std::max(1.0, std::abs(at));
      for (const ScaleOrder& o : s.orders) {
        scale += o.cosine * std::cos(o.order * at) + o.sine * std::sin(o.order * at);
        size += (std::abs(o.cosine) + std::abs(o.sine)) * (1.0 + 1e-6 * o.order * std::abs(at));
      }
      if (!agree(scale, told, size)) {
        add("gives a scale of " + to_text(scale) + " at " + to_text(at) + " rad, pieces_scale() " +
            to_text(told));
        break;
      }
    }
  }
}

/// Adds a matrix over some nodes to one over all of them.
void add_part(const Eigen::MatrixXd& part, const std::vector<int>& nodes, Eigen::MatrixXd& sum) {
  for (Eigen::Index i = 0; i < part.rows(); ++i)
    for (Eigen::Index j = 0; j < part.cols(); ++j)
      sum(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)]) += part(i, j);
}

/// The stored energy of a law that does not say that it varies, at two times and the same deflection, just beyond its
/// gap: its energy balance would be off in every run.
std::optional<Contradiction> unsaid_time(const ScalarForce& law) {
  if (law.varies()) return std::nullopt;
  constexpr double kBeyond = 1e-3, kLater = 1e-3;  // rad or m; s
  const std::optional<Gap> gap = law.gap();
  ScalarInput in{.x = gap && std::isfinite(gap->high) ? gap->high + kBeyond : kBeyond};
  const double now = law.evaluate(in).stored_energy;
  in.t = kLater;
  const double later = law.evaluate(in).stored_energy;
  if (now == later || std::isnan(now) || std::isnan(later)) return std::nullopt;
  return Contradiction{"varies", "not stated, but the stored energy is " + to_text(now) +
                                     " J at t = 0 s and " + to_text(later) + " J at t = " + to_text(kLater) +
                                     " s" + where(in) + "; a law that follows the time must state it"};
}

}  // namespace

std::optional<Contradiction> first_contradiction(const ScalarForce& law) {
  if (law.pieces().empty()) return unsaid_time(law);
  const std::vector<LawPiece> pieces = pieces_at(law, 0.0);
  std::optional<Contradiction> found = wrong_next(pieces);
  constexpr double x_part[] = {0.4}, rate_part[] = {0.8};
  for (std::size_t i = 0; i < pieces.size() && !found; ++i)
    inside_piece(pieces[i], x_part, rate_part, [&](const ScalarInput& in) {
      found = compare(pieces[i], static_cast<int>(i), law.evaluate(in), in);
    });
  return found;
}

std::vector<Contradiction> contradictions(const ScalarForce& law, std::span<const ScalarInput> at) {
  std::vector<Contradiction> found;
  compare_gap(law, found);
  if (const auto* stated = dynamic_cast<const AngleScaledForce*>(&law))
    for (const ScalarInput& in : at) compare_scale(law, *stated, in.angle, found);
  const std::span<const LawPiece> pieces = law.pieces();
  if (pieces.empty()) return found;
  if (auto wrong = wrong_next(pieces)) return {*wrong};
  PieceComparison comparison(law, 0.0, found);
  for (const LawPiece& p : pieces_at(law, 0.0))
    inside_piece(p, kPartsOfRange, kPartsOfRange, [&](const ScalarInput& in) { comparison.at(in); });
  for (const ScalarInput& in : at) PieceComparison(law, in.angle, found).at(in);
  comparison.kinks();
  comparison.gap();
  comparison.closed_slopes();
  return found;
}

std::vector<Contradiction> contradictions(const Element& element, int nodes, const Terms& whole) {
  std::vector<Contradiction> found;
  if (element.part_count() == 0) return found;
  Terms sum(nodes);
  std::vector<int> all(idx(nodes));
  std::iota(all.begin(), all.end(), 0);
  std::array<std::size_t, 5> counts{};
  const auto count = [](const Terms& t) {
    return std::array{t.scalars.size(), t.loads.size(), t.generals.size(), t.frictions.size(),
                      t.outputs.size()};
  };
  const bool in_place =
      ElementParts().for_each(element, all, [&](const Terms& part, const std::vector<int>& of_part) {
        add_part(part.mass, of_part, sum.mass);
        add_part(part.damping, of_part, sum.damping);
        add_part(part.stiffness, of_part, sum.stiffness);
        const auto more = count(part);
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += more[i];
        if (part.rayleigh != whole.rayleigh)
          found.push_back(
              {"parts", "take part in Rayleigh damping where describe() does not, or do not where it does"});
      });
  if (!in_place) return {{"parts", "have nodes that are none of the element's"}};
  constexpr const char* kNames[] = {"laws", "loads", "general forces", "frictions", "outputs"};
  const auto told = count(whole);
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] != told[i])
      found.push_back({"parts", "have " + std::to_string(counts[i]) + " " + kNames[i] +
                                    " together, describe() has " + std::to_string(told[i])});
  const auto compare = [&](const char* name, const Eigen::MatrixXd& parts, const Eigen::MatrixXd& one) {
    const double off = nodes == 0 ? 0.0 : (parts - one).cwiseAbs().maxCoeff();
    if (off > kAgree * one.cwiseAbs().maxCoeff())
      found.push_back({"parts", std::string("sum to another ") + name + " matrix than describe()'s: off by " +
                                    to_text(off)});
  };
  compare("mass", sum.mass, whole.mass);
  compare("damping", sum.damping, whole.damping);
  compare("stiffness", sum.stiffness, whole.stiffness);
  return found;
}

}  // namespace drev
