#include <drev/elements/backlash_law.hpp>

#include <cmath>

namespace drev {

namespace {
constexpr double kReferenceFraction = 1.0 / 20.0;  // of the half gap
}

BacklashLaw::BacklashLaw(const Params& params)
    : params_(params),
      half_gap_(0.5 * params.normal_backlash),
      p_ref_(std::isnan(params.reference_penetration) ? kReferenceFraction * half_gap_
                                                      : params.reference_penetration) {
  if (!has_gap()) return;
  const bool saturates = params_.damping_law == MeshDamping::proportional && params_.damping > 0.0;
  if (saturates) kinks_[kink_count_++] = -half_gap_ - p_ref_;
  kinks_[kink_count_++] = -half_gap_;
  kinks_[kink_count_++] = half_gap_;
  if (saturates) kinks_[kink_count_++] = half_gap_ + p_ref_;
}

std::optional<Gap> BacklashLaw::gap() const {
  if (!has_gap()) return std::nullopt;
  return Gap{-half_gap_, half_gap_};
}

ScalarResponse BacklashLaw::evaluate(double x, double x_dot, CurvePoint stiffness) const {
  const double k = stiffness.value, c = params_.damping;
  ScalarResponse r;
  // Side of contact: +1 in front, -1 behind, 0 in the gap.
  const double side = x > half_gap_ ? 1.0 : x < -half_gap_ ? -1.0 : 0.0;
  const double p = has_gap() ? (side == 0.0 ? 0.0 : x - side * half_gap_) : x;
  const double depth = std::abs(p);
  r.stored_energy = 0.5 * k * p * p;

  if (!has_gap() || params_.damping_law == MeshDamping::always) {
    const bool touches = !has_gap() || side != 0.0;
    r.y = k * p + c * x_dot;
    r.dy_dx = touches ? k : 0.0;
    r.dy_dx_dot = c;
    r.dy_dangle = stiffness.slope * p;
    r.dissipated_power = c * x_dot * x_dot;
    return r;
  }
  if (side == 0.0) return r;

  const bool rising = params_.damping_law == MeshDamping::proportional && depth < p_ref_;
  const double c_eff = rising ? c * depth / p_ref_ : c;
  const double y = k * p + c_eff * x_dot;
  if (y * side <= 0.0) {  // the damper would pull: the flank lets go and its energy is lost
    r.dissipated_power = -k * p * x_dot;
    return r;
  }
  if (params_.damping_law == MeshDamping::limited && c * x_dot * side > k * depth) {
    r.y = 2.0 * k * p;
    r.dy_dx = 2.0 * k;
    r.dy_dangle = 2.0 * stiffness.slope * p;
    r.dissipated_power = k * p * x_dot;
    return r;
  }
  r.y = y;
  r.dy_dx = rising ? k + c * side * x_dot / p_ref_ : k;
  r.dy_dx_dot = c_eff;
  r.dy_dangle = stiffness.slope * p;
  r.dissipated_power = c_eff * x_dot * x_dot;
  return r;
}

std::vector<LawPiece> BacklashLaw::pieces(double k) const {
  const double c = params_.damping, b = half_gap_;
  if (!has_gap()) return {{.k = k, .c = c, .elastic_k = k}};
  if (!is_linear_in_pieces()) return {};
  const MeshDamping law = c > 0.0 ? params_.damping_law : MeshDamping::always;
  // 0: the gap; in front 1: spring and damper, 2: let go, 3: damper limited to the spring's force; behind
  // 4, 5, 6 alike. With `always` only 1 and 4 (as 2) are there.
  if (law == MeshDamping::always) {
    LawPiece gap{.c = c, .bounds = {{b, -1.0, 0.0, 1}, {b, 1.0, 0.0, 2}}};
    LawPiece front{-k * b, k, c, -k * b, k, {{-b, 1.0, 0.0, 0}}};
    LawPiece back{k * b, k, c, k * b, k, {{-b, -1.0, 0.0, 0}}};
    return {gap, front, back};
  }
  const bool limited = law == MeshDamping::limited;
  std::vector<LawPiece> all(limited ? 7 : 5);
  const int per_side = limited ? 3 : 2;
  for (const int side : {1, -1}) {
    const int full = side > 0 ? 1 : 1 + per_side, free = full + 1, capped = full + 2;
    const double s = side, edge = -s * k * b;  // y = edge + k x + ...
    all[0].bounds.push_back({b, -s, 0.0, limited ? capped : full});
    const LawBound apart{-b, s, 0.0, 0};
    const auto piece = [&](int i) -> LawPiece& { return all[static_cast<std::size_t>(i)]; };
    piece(full) = {edge, k, c, edge, k, {{-k * b, s * k, s * c, free}}};
    piece(free) = {0.0, 0.0, 0.0, edge, k, {apart, {k * b, -s * k, -s * c, full}}};
    if (limited) {
      piece(full).bounds.push_back({-k * b, s * k, -s * c, capped});
      piece(capped) = {2 * edge, 2 * k, 0.0, edge, k, {apart, {k * b, -s * k, s * c, full}}};
    } else {
      piece(full).bounds.push_back(apart);
    }
  }
  return all;
}

std::vector<LawPiece> BacklashLaw::product_pieces(double k) const {
  std::vector<LawPiece> all = pieces(k);
  if (!all.empty()) return all;
  // 0: the gap; in front 1: damping rises, y = p (k + g x'), 2: the full damper, and where they let go 3, 4;
  // behind 5 to 8 alike.
  const double c = params_.damping, b = half_gap_, deep = b + p_ref_;
  all.resize(9);
  for (const int side : {1, -1}) {
    const double s = side, edge = -s * k * b, g = s * c / p_ref_;
    const int rising = side > 0 ? 1 : 5, full = rising + 1, free = rising + 2, deep_free = rising + 3;
    const auto piece = [&](int i) -> LawPiece& { return all[static_cast<std::size_t>(i)]; };
    piece(0).bounds.push_back({b, -s, 0.0, rising});
    const LawBound apart{-b, s, 0.0, 0};
    const auto shallower = [&](int next) { return LawBound{deep, -s, 0.0, next}; };
    const auto deeper = [&](int next) { return LawBound{-deep, s, 0.0, next}; };
    piece(rising) = {edge, k, -s * g * b, edge, k, {apart, shallower(full), {k, 0.0, g, free}}, g};
    piece(full) = {edge, k, c, edge, k, {deeper(rising), {-k * b, s * k, s * c, deep_free}}};
    piece(free) = {0.0, 0.0, 0.0, edge, k, {apart, shallower(deep_free), {-k, 0.0, -g, rising}}};
    piece(deep_free) = {0.0, 0.0, 0.0, edge, k, {deeper(free), {k * b, -s * k, -s * c, full}}};
  }
  return all;
}

void BacklashLaw::check(ParameterCheck& check) const {
  check.non_negative("normal_backlash", params_.normal_backlash, "m");
  check.non_negative("damping", params_.damping, "N s/m");
  if (!std::isnan(params_.reference_penetration))
    check.positive("reference_penetration", params_.reference_penetration, "m");
}

}  // namespace drev
