#include <drev/elements/polyline_spring.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

namespace {
constexpr int kFewKnots = 8;  // one after the other is faster than bisection
}

PolylineSpring::PolylineSpring(Params params) : params_(std::move(params)) {
  if (!usable()) return;  // check() says why
  find_segments();
  find_gap();
  find_pieces();
}

bool PolylineSpring::usable() const {
  const auto& x = params_.x;
  if (x.size() < 2 || params_.y.size() != x.size()) return false;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (!(x[i] > x[i - 1])) return false;
  return true;
}

PolylineSpring::Params PolylineSpring::dead_band(double stiffness, double half_gap, double damping) {
  if (half_gap == 0.0) return {.x = {-1.0, 1.0}, .y = {-stiffness, stiffness}, .damping = damping};
  return {.x = {-2.0 * half_gap, -half_gap, half_gap, 2.0 * half_gap},
          .y = {-stiffness * half_gap, 0.0, 0.0, stiffness * half_gap},
          .damping = damping};
}

PolylineSpring::Params PolylineSpring::with_stops(double stiffness, double travel, double stop_stiffness,
                                                  double damping) {
  const double at_stop = stiffness * travel, beyond = at_stop + stop_stiffness * travel;
  return {.x = {-2.0 * travel, -travel, travel, 2.0 * travel},
          .y = {-beyond, -at_stop, at_stop, beyond},
          .damping = damping};
}

void PolylineSpring::find_segments() {
  const auto &x = params_.x, &y = params_.y;
  double energy = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    segments_.push_back({x[i], y[i], (y[i + 1] - y[i]) / (x[i + 1] - x[i]), energy});
    energy += 0.5 * (y[i] + y[i + 1]) * (x[i + 1] - x[i]);
  }
  // The least energy is where y = 0: in the segment in which y changes sign. That one is written
  // from its zero, so that small deflections about the equilibrium keep all their digits.
  std::size_t i = 0;
  while (i + 1 < segments_.size() && y[i + 1] < 0.0) ++i;
  Segment& s = segments_[i];
  if (s.slope > 0.0) {
    const double from_zero = s.y / s.slope;
    s = {s.x - from_zero, 0.0, s.slope, s.energy - 0.5 * s.y * from_zero};
  }
  const double least = s.energy;
  for (Segment& other : segments_) other.energy = std::max(other.energy - least, 0.0);
}

void PolylineSpring::find_gap() {
  const auto &x = params_.x, &y = params_.y;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (y[i] != 0.0 || y[i + 1] != 0.0) continue;
    const double infinity = std::numeric_limits<double>::infinity();
    if (!gap_) gap_ = Gap{i == 0 ? -infinity : x[i], 0.0};
    gap_->high = i + 1 == segments_.size() ? infinity : x[i + 1];
  }
}

void PolylineSpring::find_pieces() {
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const double y_0 = s.y - s.slope * s.x;
    LawPiece piece{.y_0 = y_0, .k = s.slope, .c = params_.damping, .elastic_0 = y_0, .elastic_k = s.slope};
    const int own = static_cast<int>(i);
    if (i > 0) piece.bounds.push_back({-params_.x[i], 1.0, 0.0, own - 1});
    if (i + 1 < segments_.size()) piece.bounds.push_back({params_.x[i + 1], -1.0, 0.0, own + 1});
    pieces_.push_back(std::move(piece));
  }
}

std::size_t PolylineSpring::segment_at(double x) const {
  const double *first = params_.x.data() + 1, *end = params_.x.data() + params_.x.size() - 1;
  const double* above = first;
  if (end - first > kFewKnots)
    above = std::upper_bound(first, end, x);
  else
    while (above != end && !(x < *above)) ++above;
  return static_cast<std::size_t>(above - first);
}

ScalarResponse PolylineSpring::evaluate(const ScalarInput& in) const {
  const Segment& segment = segments_[segment_at(in.x)];
  const double s = in.x - segment.x, c = params_.damping;
  ScalarResponse r;
  r.y = segment.y + segment.slope * s + c * in.x_dot;
  r.dy_dx = segment.slope;
  r.dy_dx_dot = c;
  // Rounding can leave -1e-17 J at the bottom of the valley.
  r.stored_energy = std::max(segment.energy + s * (segment.y + 0.5 * segment.slope * s), 0.0);
  r.dissipated_power = c * in.x_dot * in.x_dot;
  return r;
}

double PolylineSpring::closed_stiffness() const {
  if (!gap_) return segments_[segment_at(0.0)].slope;
  const double low = segments_.front().slope, high = segments_.back().slope;
  if (low == 0.0 || high == 0.0) return std::max(low, high);
  return 0.5 * (low + high);
}

std::span<const double> PolylineSpring::kinks() const { return {params_.x.data() + 1, params_.x.size() - 2}; }

void PolylineSpring::check(ParameterCheck& check) const {
  const auto &x = params_.x, &y = params_.y;
  check.non_negative("damping", params_.damping, "N m s/rad");
  check.increasing("x", x, "rad");
  check.all_finite("y", y, "N m");
  if (x.size() < 2) check.fail("x", std::to_string(x.size()), "points", "must be at least 2");
  if (x.size() != y.size())
    check.fail("y", std::to_string(y.size()), "values",
               "must be as many as x has, " + std::to_string(x.size()));
  for (std::size_t i = 1; i < y.size(); ++i)
    if (y[i] < y[i - 1]) {
      check.fail("y[" + std::to_string(i) + "]", to_text(y[i]), "N m",
                 "must not be less than the value before it, " + to_text(y[i - 1]));
      return;
    }
  if (!usable()) return;
  const bool reaches_zero = (y.front() <= 0.0 || segments_.front().slope > 0.0) &&
                            (y.back() >= 0.0 || segments_.back().slope > 0.0);
  if (!reaches_zero)
    check.fail("y", to_text(y.front() > 0.0 ? y.front() : y.back()), "N m",
               "must pass through zero; this spring balances nowhere");
}

void PolylineSpring::describe(int nodes, Terms& terms) const {
  terms.scalars.push_back({.b = relative_motion(nodes), .force = this});
  terms.speed_ratio_constraints.push_back({.b = relative_motion(nodes), .only_in_contact = gap_.has_value()});
}

}  // namespace drev
