#include <drev/core/element.hpp>
#include <drev/elements/polyline_spring.hpp>

#include <string>

namespace drev {

namespace {

bool usable(const PolylineSpring::Params& p) {
  if (p.x.size() < 2 || p.y.size() != p.x.size()) return false;
  for (std::size_t i = 1; i < p.x.size(); ++i)
    if (!(p.x[i] > p.x[i - 1])) return false;
  return true;
}

/// Of the segment to the right of point i.
double slope(const PolylineSpring::Params& p, std::size_t i) {
  return (p.y[i + 1] - p.y[i]) / (p.x[i + 1] - p.x[i]);
}

/// A segment is a piece; none for parameters that check() refuses.
std::vector<LawPiece> pieces_of(const PolylineSpring::Params& p) {
  std::vector<LawPiece> pieces;
  if (!usable(p)) return pieces;
  for (std::size_t i = 0; i + 1 < p.x.size(); ++i) {
    const double k = slope(p, i), y_0 = p.y[i] - k * p.x[i];
    LawPiece piece{.y_0 = y_0, .k = k, .c = p.damping, .elastic_0 = y_0, .elastic_k = k};
    const int own = static_cast<int>(i);
    if (i > 0) piece.bounds.push_back({-p.x[i], 1.0, 0.0, own - 1});
    if (i + 2 < p.x.size()) piece.bounds.push_back({p.x[i + 1], -1.0, 0.0, own + 1});
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace

PolylineSpring::PolylineSpring(Params params)
    : PiecewiseForce(pieces_of(params)), params_(std::move(params)) {}

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
  if (!usable(params_)) return;
  const bool reaches_zero = (y.front() <= 0.0 || slope(params_, 0) > 0.0) &&
                            (y.back() >= 0.0 || slope(params_, x.size() - 2) > 0.0);
  if (!reaches_zero)
    check.fail("y", to_text(y.front() > 0.0 ? y.front() : y.back()), "N m",
               "must pass through zero; this spring balances nowhere");
}

void PolylineSpring::describe(int nodes, Terms& terms) const {
  terms.scalars.push_back({.b = relative_motion(nodes), .force = this});
  terms.speed_ratio_constraints.push_back(
      {.b = relative_motion(nodes), .only_in_contact = gap().has_value()});
}

}  // namespace drev
