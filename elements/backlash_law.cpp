#include <drev/elements/backlash_law.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace drev {

namespace {
constexpr double kReferenceFraction = 1.0 / 20.0;  // reference penetration over the half gap
constexpr std::size_t kMostStretches = 50;
}  // namespace

BacklashLaw::BacklashLaw(const Params& params)
    : params_(params),
      half_gap_(0.5 * params.normal_backlash),
      p_ref_(std::isnan(params.reference_penetration) ? kReferenceFraction * half_gap_
                                                      : params.reference_penetration),
      stretches_(stretches_of(params.stiffening)),
      unit_(unit_pieces()) {}

std::vector<BacklashLaw::Stretch> BacklashLaw::stretches_of(const Stiffening& stiffening) {
  std::vector<Stretch> list{{}};
  const std::size_t count = std::min(stiffening.penetrations.size(), stiffening.slopes.size());
  if (count > 0) list.front().slope = stiffening.slopes.front();
  for (std::size_t i = 1; i < count; ++i) {
    const Stretch& before = list.back();
    const double from = stiffening.penetrations[i], slope = stiffening.slopes[i];
    list.push_back({from, before.at + (before.slope - slope) * from, slope});
  }
  return list;
}

/// The law at k = 1, where x_dot stands for x_dot/k. 0: the gap; then the pieces in front, then those behind.
std::vector<LawPiece> BacklashLaw::unit_pieces() const {
  switch (has_gap() && params_.damping > 0.0 ? params_.damping_law : MeshDamping::always) {
    case MeshDamping::proportional:
      return rising_damper();
    case MeshDamping::limited:
      return switched_damper(true);
    case MeshDamping::contact_only:
      return switched_damper(false);
    case MeshDamping::always:
      break;
  }
  return plain_damper();
}

/// factor times the spring of a stretch, and a damper c; side 1: the front flank, p = x - b, -1: that behind.
LawPiece BacklashLaw::spring(std::size_t stretch, int side, double factor, double c) const {
  const Stretch& s = stretches_[stretch];
  const double edge = side * (s.at - s.slope * half_gap_);
  return {factor * edge, factor * s.slope, c, edge, s.slope, {}};
}

/// sign (S(p) + side c x_dot) > 0.
LawBound BacklashLaw::pulls(std::size_t stretch, int side, double c, double sign, int next) const {
  const Stretch& s = stretches_[stretch];
  return {sign * (s.at - s.slope * half_gap_), sign * side * s.slope, sign * side * c, next};
}

/// The ends of a stretch; below, above: the pieces behind them.
void BacklashLaw::bound_stretch(LawPiece& piece, std::size_t stretch, int side, int below, int above) const {
  const double side_of = side;
  if (stretch > 0) piece.bounds.push_back({-half_gap_ - stretches_[stretch].from, side_of, 0.0, below});
  if (stretch + 1 < stretches_.size())
    piece.bounds.push_back({half_gap_ + stretches_[stretch + 1].from, -side_of, 0.0, above});
}

/// The damper acts everywhere. Without a gap the first stretches of both sides are one piece.
std::vector<LawPiece> BacklashLaw::plain_damper() const {
  const double c = params_.damping, b = half_gap_;
  const int first = has_gap() ? 0 : 1, count = static_cast<int>(stretches_.size());
  std::vector<LawPiece> all(1);
  all[0].c = c;
  if (!has_gap()) all[0] = spring(0, 1, 1.0, c);
  const auto place = [&](int stretch, int side) {
    return stretch < first ? 0 : 1 + 2 * (stretch - first) + (side > 0 ? 0 : 1);
  };
  for (const int side : {1, -1}) {
    if (has_gap())
      all[0].bounds.push_back({b, static_cast<double>(-side), 0.0, place(0, side)});
    else
      bound_stretch(all[0], 0, side, 0, place(1, side));
  }
  for (int stretch = first; stretch < count; ++stretch)
    for (const int side : {1, -1}) {
      const auto at = static_cast<std::size_t>(stretch);
      all.push_back(spring(at, side, 1.0, c));
      if (stretch == 0) all.back().bounds.push_back({-b, static_cast<double>(side), 0.0, 0});
      bound_stretch(all.back(), at, side, place(stretch - 1, side), place(stretch + 1, side));
    }
  return all;
}

/// On each flank and stretch: spring and damper, let go, and where it is limited the damper at the spring's force.
std::vector<LawPiece> BacklashLaw::switched_damper(bool limited) const {
  const double c = params_.damping, b = half_gap_;
  const int each = limited ? 3 : 2, per_side = each * static_cast<int>(stretches_.size());
  std::vector<LawPiece> all(static_cast<std::size_t>(1 + 2 * per_side));
  for (const int side : {1, -1})
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      const int full = (side > 0 ? 1 : 1 + per_side) + each * static_cast<int>(i);
      const int free = full + 1, capped = full + 2;
      const LawBound apart{-b, static_cast<double>(side), 0.0, 0};
      const auto piece = [&](int at) -> LawPiece& { return all[static_cast<std::size_t>(at)]; };
      if (i == 0) piece(0).bounds.push_back({b, static_cast<double>(-side), 0.0, limited ? capped : full});
      piece(full) = spring(i, side, 1.0, c);
      piece(full).bounds.push_back(pulls(i, side, c, 1.0, free));
      piece(free) = spring(i, side, 0.0, 0.0);
      if (i == 0) piece(free).bounds.push_back(apart);
      piece(free).bounds.push_back(pulls(i, side, c, -1.0, full));
      if (limited) {
        piece(full).bounds.push_back(pulls(i, side, -c, 1.0, capped));
        piece(capped) = spring(i, side, 2.0, 0.0);
        if (i == 0) piece(capped).bounds.push_back(apart);
        piece(capped).bounds.push_back(pulls(i, side, -c, -1.0, full));
      } else if (i == 0) {
        piece(full).bounds.push_back(apart);
      }
      for (int at = full; at < full + each; ++at) bound_stretch(piece(at), i, side, at - each, at + each);
    }
  return all;
}

/// On each flank: the damping rises, y = p (slope + g x_dot), the full damper, and where they let go; behind the first
/// stretch the full damper and where that lets go.
std::vector<LawPiece> BacklashLaw::rising_damper() const {
  const double c = params_.damping, b = half_gap_, deep = b + p_ref_;
  const int per_side = 2 + 2 * static_cast<int>(stretches_.size());
  std::vector<LawPiece> all(static_cast<std::size_t>(1 + 2 * per_side));
  for (const int side : {1, -1}) {
    const double s = side, g = s * c / p_ref_, slope = stretches_.front().slope;
    const int rising = side > 0 ? 1 : 1 + per_side, free = rising + 2;
    const auto piece = [&](int i) -> LawPiece& { return all[static_cast<std::size_t>(i)]; };
    const LawBound apart{-b, s, 0.0, 0};
    const auto shallower = [&](int next) { return LawBound{deep, -s, 0.0, next}; };
    const auto deeper = [&](int next) { return LawBound{-deep, s, 0.0, next}; };
    piece(0).bounds.push_back({b, -s, 0.0, rising});
    piece(rising) = spring(0, side, 1.0, -s * g * b);
    piece(rising).bounds = {apart, shallower(rising + 1), {slope, 0.0, g, free}};
    piece(rising).product = g;
    piece(free) = spring(0, side, 0.0, 0.0);
    piece(free).bounds = {apart, shallower(rising + 3), {-slope, 0.0, -g, rising}};
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      const auto full_at =
          [&](int stretch) {  // of a stretch; the free piece two behind the first, else the next
            return stretch == 0 ? rising + 1 : rising + 2 + 2 * stretch;
          };
      const auto free_at = [&](int stretch) { return stretch == 0 ? rising + 3 : full_at(stretch) + 1; };
      const int at = static_cast<int>(i), full = full_at(at), deep_free = free_at(at);
      piece(full) = spring(i, side, 1.0, c);
      piece(deep_free) = spring(i, side, 0.0, 0.0);
      if (i == 0) {
        piece(full).bounds.push_back(deeper(rising));
        piece(deep_free).bounds.push_back(deeper(free));
      }
      piece(full).bounds.push_back(pulls(i, side, c, 1.0, deep_free));
      piece(deep_free).bounds.push_back(pulls(i, side, c, -1.0, full));
      bound_stretch(piece(full), i, side, full_at(at - 1), full_at(at + 1));
      bound_stretch(piece(deep_free), i, side, free_at(at - 1), free_at(at + 1));
    }
  }
  return all;
}

void BacklashLaw::check(ParameterCheck& check) const {
  check.non_negative("normal_backlash", params_.normal_backlash, "m");
  check.non_negative("damping", params_.damping, "N s/m");
  if (!std::isnan(params_.reference_penetration))
    check.positive("reference_penetration", params_.reference_penetration, "m");
  const auto &from = params_.stiffening.penetrations, &slopes = params_.stiffening.slopes;
  if (from.size() != slopes.size())
    return check.fail("stiffening.slopes", std::to_string(slopes.size()), "",
                      "must be as many as penetrations, " + std::to_string(from.size()));
  if (from.empty()) return;
  if (from.size() > kMostStretches)
    check.fail("stiffening.penetrations", std::to_string(from.size()), "",
               "must be at most " + std::to_string(kMostStretches));
  if (from.front() != 0.0)
    check.fail("stiffening.penetrations[0]", to_text(from.front()), "m", "must be 0: where the flanks meet");
  const bool rises = has_gap() && params_.damping > 0.0 && params_.damping_law == MeshDamping::proportional;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::string place = "[" + std::to_string(i) + "]";
    const double least = i == 0 ? 0.0 : i == 1 && rises ? std::max(p_ref_, 0.0) : from[i - 1];
    if (i > 0 && !(from[i] > least && std::isfinite(from[i])))
      check.fail("stiffening.penetrations" + place, to_text(from[i]), "m",
                 "must be greater than " + to_text(least) +
                     (i == 1 && rises ? ", the penetration up to which the damping rises" : ""));
    check.positive("stiffening.slopes" + place, slopes[i], "");
  }
}

}  // namespace drev
