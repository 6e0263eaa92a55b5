#include <drev/core/lanes.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/load.hpp>
#include <drev/core/motion.hpp>
#include <drev/core/table_loads.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/law/curve_cells.hpp"

namespace drev {

namespace {
constexpr int kCubicTerms = 4, kCurveTerms = CurveCells::kTerms;

/// Place of an entry's term of some degree among those of all entries, `terms` of them an entry.
std::size_t place_of_term(std::size_t entry, int degree, int terms) {
  const std::size_t lanes = kLanes, group = entry / lanes;
  return (group * static_cast<std::size_t>(terms) + static_cast<std::size_t>(degree)) * lanes + entry % lanes;
}

/// How much further on the first load's curves are than the second's, where they are of one family (the cylinders of an
/// engine) and a few angles confirm it.
std::optional<double> shift_between(const KnottedLoad& first, const KnottedLoad& second) {
  const auto *a = dynamic_cast<const SpeedScaledLoad*>(&first),
             *b = dynamic_cast<const SpeedScaledLoad*>(&second);
  if (a == nullptr || b == nullptr || a->family().id == nullptr || a->family().id != b->family().id ||
      first.turns() != second.turns())
    return std::nullopt;
  constexpr int kAngles = 16;
  constexpr double kSame = 1e-12;  // difference of equal curves over the largest
  const double shift = a->family().start - b->family().start;
  KnottedLoad::Curves largest, change;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = kTwoPi * first.turns() * (i + 0.3) / kAngles;
    const KnottedLoad::Curves c = first.curves(angle), other = second.curves(angle - shift);
    largest.factor = std::max(largest.factor, std::abs(c.factor));
    largest.by_speed_squared = std::max(largest.by_speed_squared, std::abs(c.by_speed_squared));
    change.factor = std::max(change.factor, std::abs(c.factor - other.factor));
    change.by_speed_squared =
        std::max(change.by_speed_squared, std::abs(c.by_speed_squared - other.by_speed_squared));
  }
  if (change.factor > kSame * largest.factor || change.by_speed_squared > kSame * largest.by_speed_squared)
    return std::nullopt;
  return shift;
}

}  // namespace

bool KnottedLoads::add(const Load& load, int place, double coeff, double ratio) {
  const auto* knots = dynamic_cast<const KnottedLoad*>(&load);
  if (knots == nullptr || knots->turns() == 0) return false;
  std::shared_ptr<const CurveCells> curves = curves_of(load);
  for (auto other = entries_.begin(); !curves && other != entries_.end(); ++other)
    if (const auto shift = shift_between(*knots, *other->knots))
      curves = std::make_shared<const CurveCells>(other->curves->shifted(*shift));
  if (!curves) curves = std::make_shared<const CurveCells>(*knots);
  entries_.push_back(
      {&load, knots, std::move(curves), place, coeff, ratio, load.depends_on_motion() ? coeff : 0.0});
  return true;
}

std::shared_ptr<const CurveCells> KnottedLoads::curves_of(const Load& load) const {
  for (const Entry& entry : entries_)
    if (entry.load == &load) return entry.curves;
  return nullptr;
}

KnottedLoads::Values::Values(const KnottedLoads& loads) {
  const auto n = static_cast<std::size_t>(whole_lanes(loads.size()));
  for (std::vector<double>* v :
       {&torque, &nominal_angle, &nominal_speed, &gain, &coeff, &angle, &speed, &about, &centre})
    v->assign(n, 0.0);
  place.assign(n, 0);
  called.assign(n, 0);
  low.assign(n, -std::numeric_limits<double>::infinity());
  high.assign(n, std::numeric_limits<double>::infinity());
  cubic.assign(n * kCubicTerms, 0.0);
  factor.assign(n * kCurveTerms, 0.0);
  by_speed.assign(n * kCurveTerms, 0.0);
  for (std::size_t e = 0; e < loads.entries_.size(); ++e) {
    const Entry& entry = loads.entries_[e];
    gain[e] = entry.gain;
    coeff[e] = entry.coeff;
    place[e] = entry.place;
    low[e] = std::numeric_limits<double>::infinity();  // nothing yet
  }
}

void KnottedLoads::set_nominal(double t, const MotionPoint& nominal, Values& values) const {
  values.t = t;
  values.any_called = false;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const Entry& entry = entries_[e];
    const double before = values.nominal_speed[e];
    values.nominal_angle[e] = entry.ratio * nominal.value;
    values.nominal_speed[e] = entry.ratio * nominal.rate;
    if (!entry.knots->piece_follows_speed()) continue;
    const bool called = values.nominal_speed[e] == 0.0 || nominal.acceleration != 0.0;
    if (called || values.called[e] || values.nominal_speed[e] != before)
      values.low[e] = std::numeric_limits<double>::infinity();
    values.called[e] = called;
    values.any_called = values.any_called || called;
  }
}

void KnottedLoads::take_piece(std::size_t e, Values& values) const {
  const Entry& entry = entries_[e];
  const double angle = values.angle[e];
  const CubicPiece piece =
      entry.knots->piece(angle, values.speed[e] < 0.0 ? -1.0 : 1.0, values.nominal_speed[e]);
  const CurveCells::Place place = entry.curves->at(angle);
  values.about[e] = angle;
  values.centre[e] = angle - place.distance;
  values.low[e] = std::max(piece.low, values.centre[e] - entry.curves->reach());
  values.high[e] = std::min(piece.high, values.centre[e] + entry.curves->reach());
  for (int k = 0; k < kCubicTerms; ++k)
    values.cubic[place_of_term(e, k, kCubicTerms)] = piece.terms[static_cast<std::size_t>(k)];
  for (int k = 0; k < kCurveTerms; ++k) {
    values.factor[place_of_term(e, k, kCurveTerms)] = place.cell->factor[static_cast<std::size_t>(k)];
    values.by_speed[place_of_term(e, k, kCurveTerms)] = place.cell->by_speed[static_cast<std::size_t>(k)];
  }
}

namespace {

/// Sum of terms x^k of a group of lanes, and its slope.
[[gnu::always_inline]] inline void lane_polynomial(const double* terms, int count, const Lanes& x,
                                                   Lanes& value, Lanes& slope) {
  load(terms + (count - 1) * kLanes, value);
  slope = Lanes{};
  for (int k = count - 1; k-- > 0;) {
    Lanes term;
    load(terms + k * kLanes, term);
    slope = slope * x + value;
    value = value * x + term;
  }
}

}  // namespace

DREV_WIDEST
void KnottedLoads::look_up(const double* z, const double* v, Values& values) const {
  const int lanes = static_cast<int>(values.torque.size());
  bool left_behind = false;
  for (int e = 0; e < lanes; ++e) {
    const int at = values.place.data()[e];
    const double angle = values.nominal_angle.data()[e] + values.gain.data()[e] * z[at];
    values.angle.data()[e] = angle;
    values.speed.data()[e] = values.nominal_speed.data()[e] + values.gain.data()[e] * v[at];
    left_behind |= !(angle >= values.low.data()[e] && angle <= values.high.data()[e]);
  }
  if (left_behind)
    for (std::size_t e = 0; e < entries_.size(); ++e)
      if (!values.called[e] && !(values.angle[e] >= values.low[e] && values.angle[e] <= values.high[e]))
        take_piece(e, values);
  Lanes steepest{}, steepest_by_speed{};
  for (int e = 0; e < lanes; e += kLanes) {
    Lanes angle, speed, about, gain, coeff;
    load(values.angle.data() + e, angle);
    load(values.speed.data() + e, speed);
    load(values.gain.data() + e, gain);
    load(values.coeff.data() + e, coeff);
    Lanes p, p_slope, s, s_slope, g, g_slope;
    load(values.about.data() + e, about);
    lane_polynomial(values.cubic.data() + e * kCubicTerms, kCubicTerms, angle - about, p, p_slope);
    load(values.centre.data() + e, about);
    lane_polynomial(values.factor.data() + e * kCurveTerms, kCurveTerms, angle - about, s, s_slope);
    lane_polynomial(values.by_speed.data() + e * kCurveTerms, kCurveTerms, angle - about, g, g_slope);
    const Lanes square = speed * speed, both = coeff * gain;
    store(coeff * (p * s + g * square), values.torque.data() + e);
    larger(steepest, both * (p_slope * s + p * s_slope + g_slope * square));
    larger(steepest_by_speed, both * (2.0 * g * speed));
  }
  values.steepest = values.steepest_by_speed = 0.0;
  for (int l = 0; l < kLanes; ++l) {
    values.steepest = std::max(values.steepest, steepest[l]);
    values.steepest_by_speed = std::max(values.steepest_by_speed, steepest_by_speed[l]);
  }
  if (values.any_called) call(values);
}

void KnottedLoads::call(Values& values) const {
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    if (!values.called[e]) continue;
    const Entry& entry = entries_[e];
    const LoadResponse r = entry.load->evaluate({.t = values.t,
                                                 .nominal_angle = values.nominal_angle[e],
                                                 .deviation = values.angle[e] - values.nominal_angle[e],
                                                 .speed = values.speed[e],
                                                 .nominal_speed = values.nominal_speed[e]});
    values.torque[e] = entry.coeff * r.torque;
    const double both = std::abs(entry.coeff * entry.gain);
    values.steepest = std::max(values.steepest, both * std::abs(r.dtorque_dangle));
    values.steepest_by_speed = std::max(values.steepest_by_speed, both * std::abs(r.dtorque_dspeed));
  }
}

void KnottedLoads::add_to(const Values& values, double* p) const {
  for (std::size_t e = 0; e < entries_.size(); ++e) p[entries_[e].place] += values.torque[e];
}

}  // namespace drev
