#include "models/shafts/contour_parts.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drev {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

/// Radius of the circle, with a bore, that has the torsion constant.
double equal_radius(double constant, double bore) {
  return std::pow(constant / kHalfPi + std::pow(bore, 4), 0.25);
}

/// Height over the cylinder of a round of radius rho at a distance from its end at a step of height h.
double round_height(double rho, double h, double distance) {
  if (!(rho > 0.0) || !(h > 0.0)) return 0.0;
  const double extent = h >= rho ? rho : std::sqrt(2.0 * rho * h - h * h);
  if (distance >= extent) return 0.0;
  const double along = extent - distance;
  return rho - std::sqrt(std::max(rho * rho - along * along, 0.0));
}

}  // namespace

SectionOutline keyway_of(const ShaftStation& s) {
  return keyway_outline(s.outer_diameter, s.keyway->width, s.keyway->depth, s.keyway->corner_radius);
}
SectionOutline spline_of(const ShaftStation& s) {
  return spline_outline(s.spline->teeth, s.spline->minor_diameter, s.outer_diameter, s.spline->tooth_width,
                        s.spline->root_radius);
}
SectionOutline cam_of(const ShaftStation& s) {
  return cam_outline(0.5 * s.outer_diameter, PeriodicCurve(s.cam->lift, s.cam->interpolation),
                     0.5 * s.inner_diameter);
}

double groove_half_width(const ShaftGroove& g) {
  return g.depth >= g.radius ? g.radius
                             : std::sqrt(std::max(2.0 * g.radius * g.depth - g.depth * g.depth, 0.0));
}

std::vector<int> segment_counts(const ShaftContour& contour) {
  std::vector<int> counts;
  for (const ShaftStation& s : contour.stations)
    counts.push_back(
        std::isnan(contour.up_to_frequency)
            ? 1
            : segments_for(s.length, torsional_wave_speed(contour.shear_modulus, contour.density),
                           contour.frequency_accuracy, contour.up_to_frequency, contour.mass, 1.0));
  return counts;
}

namespace {

StationSection station_section(const ShaftStation& s, double accuracy) {
  StationSection found;
  found.least = found.most = 0.5 * s.outer_diameter;
  const auto solve = [&](const SectionOutline& outline) {
    found.round = false;
    try {
      found.torsion = solve_section(outline, std::min(accuracy, 1e-3));
    } catch (const SolverError& error) {
      throw ModelError(
          {{"shaft", "section", s.name, "", "must be one that can be meshed: " + std::string(error.what())}});
    }
    found.most = outline.size;
  };
  const double bore = kHalfPi * std::pow(0.5 * s.inner_diameter, 4);
  if (s.cam) {
    solve(cam_of(s));
    double least = HUGE_VAL;
    const PeriodicCurve lift(s.cam->lift, s.cam->interpolation);
    for (int i = 0; i < 720; ++i) least = std::min(least, lift.at(4.0 * kHalfPi * i / 720).value);
    found.least += least;
  } else if (s.keyway || s.spline) {
    solve(s.keyway ? keyway_of(s) : spline_of(s));
    found.torsion.constant.value -= bore;
    found.torsion.polar -= bore;
    if (s.spline) found.least = 0.5 * s.spline->minor_diameter;
  }
  return found;
}

bool same_section(const ShaftStation& a, const ShaftStation& b) {
  if (a.outer_diameter != b.outer_diameter || a.inner_diameter != b.inner_diameter) return false;
  if (a.cam && b.cam)
    return a.cam->interpolation == b.cam->interpolation && a.cam->lift.period() == b.cam->lift.period() &&
           a.cam->lift.values() == b.cam->lift.values() && a.cam->lift.arguments() == b.cam->lift.arguments();
  if (a.keyway && b.keyway)
    return a.keyway->width == b.keyway->width && a.keyway->depth == b.keyway->depth &&
           a.keyway->corner_radius == b.keyway->corner_radius;
  if (a.spline && b.spline)
    return a.spline->teeth == b.spline->teeth && a.spline->minor_diameter == b.spline->minor_diameter &&
           a.spline->tooth_width == b.spline->tooth_width && a.spline->root_radius == b.spline->root_radius;
  return false;
}

}  // namespace

std::vector<StationSection> station_sections(const ShaftContour& contour) {
  std::vector<StationSection> sections;
  for (const ShaftStation& s : contour.stations) {
    std::size_t same = 0;
    while (same < sections.size() && !same_section(contour.stations[same], s)) ++same;
    sections.push_back(same < sections.size() ? sections[same] : station_section(s, contour.accuracy));
  }
  return sections;
}

ContourParts::ContourParts(const ShaftContour& contour, const std::vector<StationSection>& sections,
                           ContourVariant variant)
    : sections_(sections) {
  for (std::size_t k = 0; k < contour.stations.size(); ++k) {
    const ShaftStation& s = contour.stations[k];
    const StationSection& section = sections[k];
    RevolvedStation piece;
    piece.length = s.length;
    piece.bore = 0.5 * s.inner_diameter;
    piece.left = piece.right = 0.5 * s.outer_diameter;
    if (!std::isnan(s.end_diameter)) piece.right = 0.5 * s.end_diameter;
    if (!std::isnan(s.hub_diameter) && variant != ContourVariant::soft)
      piece.left = piece.right = 0.5 * s.hub_diameter;
    if (s.cam || s.spline)
      piece.left = piece.right = variant == ContourVariant::soft ? section.least
                                 : variant == ContourVariant::stiff
                                     ? section.most
                                     : equal_radius(section.torsion.constant.value, piece.bore);
    if (s.keyway)
      piece.factor =
          section.torsion.constant.value / (kHalfPi * (std::pow(piece.left, 4) - std::pow(piece.bore, 4)));
    piece.round_left = s.fillet_start;
    piece.round_right = s.fillet_end;
    if (s.groove) {
      const double half = groove_half_width(*s.groove), from = s.groove->position - half,
                   to = s.groove->position + half;
      RevolvedStation before = piece, groove = piece, behind = piece;
      before.length = from, behind.length = s.length - to, groove.length = 2.0 * half;
      groove.left = groove.right = piece.left - s.groove->depth;
      before.round_right = behind.round_left = 0.0;
      groove.round_left = groove.round_right = s.groove->radius;
      for (const RevolvedStation& part : {before, groove, behind})
        pieces_.push_back(part), station_.push_back(static_cast<int>(k));
    } else {
      pieces_.push_back(piece);
      station_.push_back(static_cast<int>(k));
    }
  }
}

std::pair<double, double> ContourParts::radii(std::size_t station) const {
  const auto first =
      std::find(station_.begin(), station_.end(), static_cast<int>(station)) - station_.begin();
  auto last = static_cast<std::size_t>(first);
  while (last + 1 < station_.size() && station_[last + 1] == static_cast<int>(station)) ++last;
  return {pieces_[static_cast<std::size_t>(first)].left, pieces_[last].right};
}

std::size_t ContourParts::piece_at(double& z) const {
  std::size_t k = 0;
  for (; k + 1 < pieces_.size() && z > pieces_[k].length; ++k) z -= pieces_[k].length;
  return k;
}

ContourParts::Slice ContourParts::section_at(double z) const {
  const std::size_t k = piece_at(z);
  const RevolvedStation& p = pieces_[k];
  double r = p.left + (p.right - p.left) * z / p.length;
  if (k > 0) r += round_height(p.round_left, pieces_[k - 1].right - p.left, z);
  if (k + 1 < pieces_.size()) r += round_height(p.round_right, pieces_[k + 1].left - p.right, p.length - z);
  return {r, p.bore, p.factor};
}

double ContourParts::polar(double z) const {
  double in_piece = z;
  const StationSection& section = sections_[static_cast<std::size_t>(station_[piece_at(in_piece)])];
  if (!section.round) return section.torsion.polar;
  const Slice slice = section_at(z);
  return kHalfPi * (std::pow(slice.radius, 4) - std::pow(slice.bore, 4));
}

}  // namespace drev
