#include <drev/core/error.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/shafts/contour_parts.hpp"
#include "models/shafts/published_factors.hpp"
#include "models/shafts/revolved_torsion.hpp"

namespace drev {
namespace {

constexpr double kRoundJ = 0.5 * std::numbers::pi;  // of radius 1

double ring(double radius, double bore) { return kRoundJ * (std::pow(radius, 4) - std::pow(bore, 4)); }

/// Polar section modulus of a ring by its radii [m^3].
double ring_modulus(double radius, double bore) { return ring(radius, bore) / radius; }

/// The G theta/T of pieces taken each with its own J over its length.
double piece_flexibility(const RevolvedStation& p) {
  if (p.left == p.right) return p.length / (p.factor * ring(p.left, p.bore));
  if (p.bore == 0.0)
    return cone_flexibility(2.0 * std::min(p.left, p.right), 2.0 * std::max(p.left, p.right), p.length);
  // Simpson's rule: 1/J of a bored cone is smooth.
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight / ring(p.left + (p.right - p.left) * i / kSteps, p.bore);
  }
  return sum * p.length / (3.0 * kSteps);
}

/// Polar moment integrated between two planes by Simpson's rule, to which kinks at fillets matter little.
double polar_volume(const ContourParts& parts, double from, double to) {
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const double inside = std::clamp(double(i), 1e-6, kSteps - 1e-6) / kSteps;  // on this side of steps
    sum += weight * parts.polar(from + (to - from) * inside);
  }
  return sum * (to - from) / (3.0 * kSteps);
}

/// Stress of a station over its nominal one: the body of revolution, or the section's own peak.
void find_stress(ShaftSection& section, const ShaftStation& station, const StationSection& plane,
                 std::size_t k, const ContourParts& parts, const RevolvedTorsion& whole,
                 const std::vector<SharpEdge>& edges) {
  const double modulus = ring_modulus(0.5 * section.diameter, 0.5 * section.bore);
  SharpEdge sharp = SharpEdge::none;
  section.stress_factor = {1.0, 0.0, Estimate::Kind::estimate};
  section.stress_place = "surface";
  for (std::size_t p = 0; p < parts.pieces().size(); ++p) {
    if (parts.station()[p] != static_cast<int>(k)) continue;
    sharp = std::max(sharp, edges[p]);
    const double factor = whole.peak[p].value * modulus;
    if (factor <= section.stress_factor.value) continue;
    section.stress_factor = {factor, whole.peak[p].error * modulus, Estimate::Kind::estimate};
    section.stress_place = station.groove && p > 0 && parts.station()[p - 1] == static_cast<int>(k) ? "groove"
                           : station.fillet_start > 0.0 || station.fillet_end > 0.0                 ? "fillet"
                                                                                    : "surface";
  }
  if (!plane.round) {
    const SectionTorsion& t = plane.torsion;
    const double factor = t.peak_stress.value / t.constant.value * modulus;
    if (factor > section.stress_factor.value || station.cam || station.spline) {
      section.stress_factor = {factor, factor * t.peak_stress.error / t.peak_stress.value,
                               Estimate::Kind::estimate};
      section.stress_place = station.cam ? "cam" : station.spline ? "spline" : "keyway";
    }
  }
  if (sharp != SharpEdge::none) {
    section.stress_factor = {HUGE_VAL, 0.0, Estimate::Kind::estimate};
    section.stress_place = sharp == SharpEdge::shoulder ? "sharp shoulder" : "sharp corner";
  }
}

/// Throws ModelError with everything that cannot be.
std::vector<StationSection> sound_sections(const ShaftContour& contour) {
  std::vector<Finding> findings;
  ParameterCheck check("shaft", findings);
  std::vector<StationSection> sections = check_contour(contour, check);
  if (!findings.empty()) throw ModelError(findings);
  return sections;
}

/// Surface for drawing, with the stress of the bodies of revolution by slices.
void draw_outline(ShaftSections& found, const ContourParts& parts, double length) {
  constexpr int kPoints = 600;
  for (int i = 0; i <= kPoints; ++i) {
    const double z = length * std::clamp(double(i), 1e-3, kPoints - 1e-3) / kPoints;
    const auto [radius, bore, factor] = parts.section_at(z);
    found.outline_z.push_back(length * i / kPoints);
    found.outline_r.push_back(radius);
    found.outline_stress.push_back(radius / (factor * ring(radius, bore)));
  }
}

/// What cannot be meshed is a contour that is refused.
RevolvedTorsion solve_contour(const std::vector<RevolvedStation>& pieces, const std::vector<double>& planes,
                              const RevolvedOptions& options) {
  try {
    return solve_revolved(pieces, planes, options);
  } catch (const SolverError& error) {
    throw ModelError({{"shaft", "stations", std::to_string(pieces.size()), "",
                       "must be a contour that can be meshed: " + std::string(error.what())}});
  }
}

}  // namespace

double ShaftSections::inertia() const {
  double sum = 0.0;
  for (const ShaftSection& s : sections) sum += s.inertia;
  return sum;
}

ShaftSections shaft_sections(const ShaftContour& contour) {
  const std::vector<StationSection> planes_of = sound_sections(contour);
  const ContourParts parts(contour, planes_of, ContourVariant::likely);
  ShaftSections found;
  found.shear_modulus = contour.shear_modulus;
  found.density = contour.density;
  const std::vector<int> counts = segment_counts(contour);
  double z = 0.0;
  for (std::size_t k = 0; k < contour.stations.size(); ++k) {
    for (int i = 0; i < counts[k]; ++i) {
      found.planes.push_back(z + contour.stations[k].length * i / counts[k]);
      found.segment_station.push_back(static_cast<int>(k));
    }
    z += contour.stations[k].length;
  }
  found.planes.push_back(z);
  const std::vector<SharpEdge> edges = sharp_edges(parts.pieces());
  RevolvedOptions options{.accuracy = contour.accuracy};
  for (std::size_t p = 0; p < parts.pieces().size(); ++p) {
    const RevolvedStation& piece = parts.pieces()[p];
    options.judge.push_back((piece.round_left > 0.0 || piece.round_right > 0.0) &&
                            edges[p] == SharpEdge::none);
  }
  const std::vector<double> inner(found.planes.begin() + 1, found.planes.end() - 1);
  const RevolvedTorsion whole = solve_contour(parts.pieces(), inner, options);
  found.flexibility = whole.flexibility;
  found.unknowns = whole.unknowns;
  for (std::size_t s = 0; s + 1 < found.planes.size(); ++s) {
    found.segment_flexibility.push_back(whole.spans[s].value);
    found.segment_inertia.push_back(contour.density *
                                    polar_volume(parts, found.planes[s], found.planes[s + 1]));
  }
  double from = 0.0;
  for (std::size_t k = 0; k < contour.stations.size(); ++k) {
    const ShaftStation& station = contour.stations[k];
    ShaftSection section;
    section.name = station.name.empty() ? std::to_string(k + 1) : station.name;
    section.from = from;
    section.length = station.length;
    section.bore = station.inner_diameter;
    section.diameter = HUGE_VAL;
    for (std::size_t p = 0; p < parts.pieces().size(); ++p)
      if (parts.station()[p] == static_cast<int>(k)) {
        const RevolvedStation& piece = parts.pieces()[p];
        const bool own = station.cam || station.spline || !std::isnan(station.hub_diameter);
        const double least = station.spline ? planes_of[k].least : 0.5 * station.outer_diameter;
        section.diameter =
            std::min(section.diameter, 2.0 * (own ? least : std::min(piece.left, piece.right)));
        section.naive_flexibility += piece_flexibility(piece);
      }
    section.torsion_constant = station.length / section.naive_flexibility;
    for (std::size_t s = 0; s < found.segment_station.size(); ++s)
      if (found.segment_station[s] == static_cast<int>(k)) {
        section.flexibility += found.segment_flexibility[s];
        section.inertia += found.segment_inertia[s];
      }
    find_stress(section, station, planes_of[k], k, parts, whole, edges);
    found.naive_flexibility += section.naive_flexibility;
    from += station.length;
    found.sections.push_back(std::move(section));
  }
  draw_outline(found, parts, z);
  return found;
}

ShaftBounds shaft_bounds(const ShaftContour& contour) {
  const std::vector<StationSection> sections = sound_sections(contour);
  const auto bound = [&](ContourVariant variant) {
    return contour.shear_modulus / solve_contour(ContourParts(contour, sections, variant).pieces(), {},
                                                 {.accuracy = contour.accuracy})
                                       .flexibility.value;
  };
  return {bound(ContourVariant::soft), bound(ContourVariant::stiff)};
}

}  // namespace drev
