#include "solvers/exact/smooth_loads.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/law/ranged.hpp"
#include "solvers/contact/roots.hpp"
#include "solvers/exact/expanded_loads.hpp"

namespace drev {

namespace {
constexpr double kTorqueRounding = 1e-15;  // of a torque, an angle and a speed, relative to them
}  // namespace

void SmoothLoads::find_loads(const MotionPoint& nominal) {
  const bool constant = ExpandedLoads::is_constant(nominal);
  if (found_ && constant == constant_) return;
  found_ = true;
  constant_ = constant;
  loads_.clear();
  for (const Added& added : all_) {
    if (added.expanded && ExpandedLoads::holds(system_, *added.term, constant)) continue;
    loads_.emplace_back(system_, *added.term);
    loads_.back().knots = dynamic_cast<const KnottedLoad*>(added.term->load);
  }
}

void SmoothLoads::move(const Assembler& assembler, const Vector& z, const Vector& v) {
  t_ = assembler.time();
  const MotionPoint& nominal = assembler.nominal();
  nominal_ = nominal.value;
  find_loads(nominal);
  for (Place& l : loads_) {
    l.move(system_, nominal, z, v);
    const LoadResponse r = assembler.load(*l.term, z, v);
    l.torque = r.torque;
    l.slope = l.feedback ? r.dtorque_dangle : 0.0;
    l.speed_slope =
        l.feedback && l.row < system_.size() && std::isfinite(r.dtorque_dspeed) ? r.dtorque_dspeed : 0.0;
    if (l.knots != nullptr) l.follow(l.angle, l.speed, l.ratio * nominal.rate);
  }
}

void SmoothLoads::move_as(const SmoothLoads& other) {
  t_ = other.t_;
  nominal_ = other.nominal_;
  loads_ = other.loads_;
  found_ = other.found_;
  constant_ = other.constant_;
}

void SmoothLoads::add_to(double h, const std::array<double, 3>& phi, double* p) {
  h_ = h;
  phi_ = phi;
  for (const Place& l : loads_) l.add_to(h, phi, stride_, p);
}

void SmoothLoads::add_slopes(TaylorSeries& series) const {
  for (const Place& l : loads_) l.add_slopes(series, nominal_speed_of(l, 0.0));
}

void SmoothLoads::find_angle(const Place& l, const TaylorSeries& series, std::vector<double>& terms) const {
  terms.assign(idx(std::max(series.degree(), 2)) + 1, 0.0);
  for (int k = 1; l.feedback && k <= series.degree(); ++k)
    terms[idx(k)] = l.coeff * series.coefficient(k, l.row);
  for (std::size_t k = 1; k < 3; ++k) terms[k] += l.ratio * phi_[k];
}

SmoothLoads::Point SmoothLoads::look(const Place& l, double s, double along, double rate,
                                     LoadResponse& r) const {
  const double turn = (phi_[1] + phi_[2] * s) * s, deviation = l.coeff * along;
  const double nominal_speed = nominal_speed_of(l, s);
  const LoadInput in{.t = t_ + h_ * s,
                     .nominal_angle = l.ratio * (nominal_ + turn),
                     .deviation = deviation,
                     .speed = nominal_speed + l.coeff * rate,
                     .nominal_speed = nominal_speed};
  r = l.term->load->evaluate(in);
  double tangent = l.slope == 0.0 ? 0.0 : l.slope * (l.ratio * turn + deviation - l.deviation);
  if (l.speed_slope != 0.0) tangent += l.speed_slope * (in.speed - l.speed);
  return {s, in.nominal_angle + deviation, in.speed, l.coeff * (r.torque - l.torque - tangent), r.torque};
}

/// What a called load does between the points at which it was called.
class SmoothLoads::Between {
 public:
  Between(const SmoothLoads& of, const Place& load, const TaylorSeries& series)
      : of_(of), load_(load), series_(series), fit_(load.at_nodes) {}

  Point look(double s) const {
    double along = 0.0, rate = 0.0;
    for (int k = series_.degree(); load_.feedback && k >= 0; --k) {
      rate = rate * s + along;
      along = along * s + series_.coefficient(k, load_.row);
    }
    LoadResponse r;
    return of_.look(load_, s, along, rate / of_.h_, r);
  }

  /// Looks where angle or speed turn back between the points: a kink may stand there, beyond all of them.
  void look_at_turns() {
    const auto& p = load_.points;
    for (const auto of : {&Point::angle, &Point::speed}) {
      std::vector<double> path;  // by powers of s
      for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        const double before = (p[i].*of - p[i - 1].*of) / (p[i].s - p[i - 1].s),
                     behind = (p[i + 1].*of - p[i].*of) / (p[i + 1].s - p[i].s);
        if (!(before * behind < 0.0)) continue;
        if (path.empty()) {
          of_.find_angle(load_, series_, path);
          if (of == &Point::speed) differentiate(path);
        }
        // Newton's method from the top of a parabola through the three points.
        const double part = before / (before - behind);
        double s = 0.5 * (p[i].s + (1.0 - part) * p[i - 1].s + part * p[i + 1].s);
        for (int k = 0; k < kTurnNewton; ++k) {
          const double next = s - polynomial_slope(path, s) / polynomial_curvature(path, s);
          if (!(next > p[i - 1].s && next < p[i + 1].s)) break;
          s = next;
        }
        take(look(s));
      }
    }
  }

  /// Looks wherever the load may do what the nodes do not show. False: nobody knows what it may do.
  bool divides() {
    const std::optional<double> may = bound(load_.points);
    if (!may) return false;
    if (hides(load_.points, *may))
      for (std::size_t i = 0; i + 1 < load_.points.size(); ++i)
        divide(load_.points[i], load_.points[i + 1], kDeepest);
    return true;
  }

  Point take(const Point& p) {
    ++looks_;
    off_ = std::max(off_, std::abs(p.beyond - fit_.at(p.s)));
    return p;
  }
  /// The most that the load was off its projection.
  double off() const { return off_; }

 private:
  // How much more than its points show a load may change between them; how often a part is halved; looks at most.
  static constexpr double kMore = 8.0;
  static constexpr int kDeepest = 14, kMostLooks = 400, kTurnNewton = 3;
  // The path between points comes beyond them, relative to what they span.
  static constexpr double kBeyond = 0.3;

  /// How far the load may change over the points' ranges [N m]. None: it does not say.
  std::optional<double> bound(std::span<const Point> points) const {
    LoadRanges over;
    over.t = {of_.t_ + of_.h_ * points.front().s, of_.t_ + of_.h_ * points.back().s};
    over.angle = {points[0].angle, points[0].angle};
    over.speed = {points[0].speed, points[0].speed};
    for (const Point& p : points) {
      over.angle = hull(over.angle, {p.angle, p.angle});
      over.speed = hull(over.speed, {p.speed, p.speed});
    }
    const double first = of_.nominal_speed_of(load_, points.front().s),
                 last = of_.nominal_speed_of(load_, points.back().s);
    over.nominal_speed = {std::min(first, last), std::max(first, last)};
    const auto widen = [](Interval& x) {
      const double by = kBeyond * (x.high - x.low);
      x = {x.low - by, x.high + by};
    };
    widen(over.angle);
    if (load_.feedback) widen(over.speed);
    const std::optional<LoadSlopes> slopes = load_.term->load->steepest(over);
    if (!slopes) return std::nullopt;
    const auto change = [](double slope, const Interval& x) {
      return x.high > x.low && slope > 0.0 ? slope * (x.high - x.low) : 0.0;
    };
    // A load that says its knots does nothing over the angle between them that the nodes do not show.
    const double by_angle = load_.knots != nullptr ? 0.0 : slopes->by_angle;
    return std::abs(load_.coeff) * (change(slopes->by_time, over.t) + change(by_angle, over.angle) +
                                    change(slopes->by_speed, over.speed));
  }

  /// Whether it may change, by `may` at most, by far more than the points show, and move something by it.
  bool hides(std::span<const Point> points, double may) const {
    if (may * (points.back().s - points.front().s) <= load_.least) return false;
    double shown = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      shown += std::abs(load_.coeff * (points[i + 1].torque - points[i].torque));
    return !(may <= kMore * shown);
  }

  static void differentiate(std::vector<double>& terms) {
    for (std::size_t k = 1; k < terms.size(); ++k) terms[k - 1] = static_cast<double>(k) * terms[k];
    terms.pop_back();
  }

  void divide(const Point& a, const Point& b, int depth) {
    if (looks_ >= kMostLooks) return;
    const Point middle = take(look(0.5 * (a.s + b.s)));
    const std::array<Point, 3> points{a, middle, b};
    if (depth == 0 || !hides(points, bound(points).value_or(0.0))) return;
    divide(a, middle, depth - 1);
    divide(middle, b, depth - 1);
  }

  const SmoothLoads& of_;
  const Place& load_;
  const TaylorSeries& series_;
  NodeFit fit_;  // of the load alone
  double off_ = 0.0;
  int looks_ = 0;
};

double SmoothLoads::differ_called(Place& l, const TaylorSeries& series, NodeForces& forces) const {
  const GaussRule& rule = gauss_rule();
  double gain = 0.0;
  l.points.front() = {0.0, l.angle, l.speed, 0.0, l.torque};
  l.rounding = 0.0;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    const std::size_t at = q * idx(stride_) + idx(l.row);
    LoadResponse r;
    const Point& p = l.points[q + 1] = look(l, rule.s[q], path_[at], rate_[at], r);
    if (l.feedback)
      gain = std::max(gain, 0.5 * h_ * h_ * std::abs(r.dtorque_dangle - l.slope) +
                                h_ * std::abs(r.dtorque_dspeed - l.speed_slope));
    l.rounding = std::max(
        l.rounding, kTorqueRounding * std::abs(l.coeff) *
                        (std::abs(r.torque) + std::abs(r.dtorque_dangle) * std::max(1.0, std::abs(p.angle)) +
                         std::abs(r.dtorque_dspeed * p.speed)));
    l.at_nodes[q] = p.beyond;
    forces.at(q, l.row) += p.beyond;
  }
  l.points.back() = Between(*this, l, series).look(GaussRule::kAheadOfEnd);
  l.off_at_ends = rule.off_at_ends(l.at_nodes, 0.0, l.points.back().beyond);
  return gain;
}

void SmoothLoads::look_between(const TaylorSeries& series) {
  constexpr int kPlaces = GaussRule::kNodes;  // between the nodes, and behind the last
  static const auto places = [] {
    std::array<double, kPlaces> s{};
    for (std::size_t q = 0; q < kPlaces; ++q)
      s[q] = 0.5 * (gauss_rule().s[q] + (q + 1 < kPlaces ? gauss_rule().s[q + 1] : 1.0));
    return s;
  }();
  bool found = false;  // the path there
  for (Place& l : loads_) {
    if (l.knots != nullptr && !l.is_called()) continue;
    Between between(*this, l, series);
    if (l.feedback) between.look_at_turns();
    if (!between.divides()) {
      if (!std::exchange(found, true)) series.at_places(kPlaces, places.data(), path_.data(), rate_.data());
      between.take(between.look(0.5 * gauss_rule().s[0]));
      for (std::size_t q = 0; q < kPlaces; ++q) {
        const std::size_t at = q * idx(stride_) + idx(l.row);
        LoadResponse r;
        between.take(look(l, places[q], path_[at], rate_[at], r));
      }
    }
    l.off_at_ends = std::max(l.off_at_ends, between.off());
  }
}

double SmoothLoads::project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                            LegendreProjection& kinks) {
  places_.clear();
  if (loads_.empty()) return 0.0;
  if (first) known_.clear();
  forces_ = known_;
  double contraction = 0.0;
  for (Place& l : loads_) {
    if (!l.feedback && !first && l.knots == nullptr) continue;
    NodeForces& forces = l.feedback || l.knots != nullptr ? forces_ : known_;
    const double gain =
        l.knots != nullptr ? differ_knotted(l, series, forces, kinks) : differ_called(l, series, forces);
    contraction = std::max(contraction, l.coeff * l.coeff * series.mobility(l.row) * gain);
  }
  projection.add_nodes(forces_);
  if (first) projection.add_nodes(known_);
  return contraction;
}

double SmoothLoads::slope_work(const TaylorSeries& series, double s, const Vector& end) {
  double sum = 0.0;
  for (const Place& l : loads_) {
    const double turn = l.coeff * (l.along(system_, end) - series.coefficient(0, l.row));
    sum += 0.5 * l.slope * turn * turn;
    if (l.speed_slope == 0.0) continue;
    find_angle(l, series, turn_);
    NodeValues angle;
    find_at_nodes(turn_, s, angle);
    const GaussRule& rule = gauss_rule();
    const double first = l.speed - nominal_speed_of(l, 0.0);
    for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
      const double rate = angle.slope[q] / h_ - nominal_speed_of(l, s * rule.s[q]);
      sum += h_ * s * rule.weight[q] * l.speed_slope * (rate - first) * rate;
    }
  }
  return sum;
}

}  // namespace drev
