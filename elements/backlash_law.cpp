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
                                                      : params.reference_penetration),
      unit_(unit_pieces()) {}

/// The law at k = 1, where x_dot stands for x_dot/k. 0: the gap; then the pieces in front, then those behind.
std::vector<LawPiece> BacklashLaw::unit_pieces() const {
  const double c = params_.damping;
  if (!has_gap()) return {{.k = 1.0, .c = c, .elastic_k = 1.0}};
  switch (c > 0.0 ? params_.damping_law : MeshDamping::always) {
    case MeshDamping::proportional:
      return rising_damper();
    case MeshDamping::limited:
      return switched_damper(true);
    case MeshDamping::contact_only:
      return switched_damper(false);
    case MeshDamping::always:
      break;
  }
  const double b = half_gap_;
  return {{.c = c, .bounds = {{b, -1.0, 0.0, 1}, {b, 1.0, 0.0, 2}}},
          {-b, 1.0, c, -b, 1.0, {{-b, 1.0, 0.0, 0}}},
          {b, 1.0, c, b, 1.0, {{-b, -1.0, 0.0, 0}}}};
}

/// On each flank: spring and damper, let go, and where it is limited the damper at the spring's force.
std::vector<LawPiece> BacklashLaw::switched_damper(bool limited) const {
  const double c = params_.damping, b = half_gap_;
  const int per_side = limited ? 3 : 2;
  std::vector<LawPiece> all(static_cast<std::size_t>(1 + 2 * per_side));
  for (const int side : {1, -1}) {
    const int full = side > 0 ? 1 : 1 + per_side, free = full + 1, capped = full + 2;
    const double s = side, edge = -s * b;  // the spring: edge + x
    const LawBound apart{-b, s, 0.0, 0};
    const auto piece = [&](int i) -> LawPiece& { return all[static_cast<std::size_t>(i)]; };
    piece(0).bounds.push_back({b, -s, 0.0, limited ? capped : full});
    piece(full) = {edge, 1.0, c, edge, 1.0, {{-b, s, s * c, free}}};
    piece(free) = {0.0, 0.0, 0.0, edge, 1.0, {apart, {b, -s, -s * c, full}}};
    if (limited) {
      piece(full).bounds.push_back({-b, s, -s * c, capped});
      piece(capped) = {2 * edge, 2.0, 0.0, edge, 1.0, {apart, {b, -s, s * c, full}}};
    } else {
      piece(full).bounds.push_back(apart);
    }
  }
  return all;
}

/// On each flank: the damping rises, y = p (1 + g x_dot), the full damper, and where they let go.
std::vector<LawPiece> BacklashLaw::rising_damper() const {
  const double c = params_.damping, b = half_gap_, deep = b + p_ref_;
  std::vector<LawPiece> all(9);
  for (const int side : {1, -1}) {
    const double s = side, edge = -s * b, g = s * c / p_ref_;
    const int rising = side > 0 ? 1 : 5, full = rising + 1, free = rising + 2, deep_free = rising + 3;
    const auto piece = [&](int i) -> LawPiece& { return all[static_cast<std::size_t>(i)]; };
    const LawBound apart{-b, s, 0.0, 0};
    const auto shallower = [&](int next) { return LawBound{deep, -s, 0.0, next}; };
    const auto deeper = [&](int next) { return LawBound{-deep, s, 0.0, next}; };
    piece(0).bounds.push_back({b, -s, 0.0, rising});
    piece(rising) = {edge, 1.0, -s * g * b, edge, 1.0, {apart, shallower(full), {1.0, 0.0, g, free}}, g};
    piece(full) = {edge, 1.0, c, edge, 1.0, {deeper(rising), {-b, s, s * c, deep_free}}};
    piece(free) = {0.0, 0.0, 0.0, edge, 1.0, {apart, shallower(deep_free), {-1.0, 0.0, -g, rising}}};
    piece(deep_free) = {0.0, 0.0, 0.0, edge, 1.0, {deeper(free), {b, -s, -s * c, full}}};
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
