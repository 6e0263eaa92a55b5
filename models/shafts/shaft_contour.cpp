#include <drev/core/error.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

#include <algorithm>
#include <cmath>

#include "models/shafts/contour_parts.hpp"

namespace drev {
namespace {

std::string station_key(std::size_t k, const std::string& key) {
  return "stations[" + std::to_string(k + 1) + "]." + key;
}

/// Passes on what an outline refuses, with the name of the feature before the parameter's.
template <class Make>
void try_outline(ParameterCheck& check, std::size_t k, const char* feature, const Make& make) {
  try {
    make();
  } catch (const ModelError& error) {
    for (const Finding& f : error.findings())
      check.fail(station_key(k, std::string(feature) + "." + f.parameter), f.value, f.unit, f.range);
  }
}

void check_numbers(ParameterCheck& check, std::size_t k, const ShaftStation& s) {
  check.positive(station_key(k, "length"), s.length, "m");
  check.positive(station_key(k, "outer_diameter"), s.outer_diameter, "m");
  check.non_negative(station_key(k, "inner_diameter"), s.inner_diameter, "m");
  check.non_negative(station_key(k, "fillet_start"), s.fillet_start, "m");
  check.non_negative(station_key(k, "fillet_end"), s.fillet_end, "m");
  if (!std::isnan(s.end_diameter)) check.positive(station_key(k, "end_diameter"), s.end_diameter, "m");
  if (!std::isnan(s.hub_diameter) && !(s.hub_diameter > s.outer_diameter && std::isfinite(s.hub_diameter)))
    check.fail(station_key(k, "hub_diameter"), to_text(s.hub_diameter), "m",
               "must exceed outer_diameter, " + to_text(s.outer_diameter));
  const int features = (s.groove ? 1 : 0) + (s.keyway ? 1 : 0) + (s.spline ? 1 : 0) + (s.cam ? 1 : 0) +
                       (std::isnan(s.end_diameter) ? 0 : 1) + (std::isnan(s.hub_diameter) ? 0 : 1);
  if (features > 1)
    check.fail(
        station_key(k, "length"), to_text(s.length), "m",
        "belongs to a station with more than one of end_diameter, hub_diameter, groove, keyway, spline and "
        "cam: divide it");
  if (!std::isnan(s.end_diameter) && (s.fillet_start > 0.0 || s.fillet_end > 0.0))
    check.fail(station_key(k, "fillet_start"), to_text(std::max(s.fillet_start, s.fillet_end)), "m",
               "must be 0 on a taper, as fillet_end: a fillet lies on a cylinder");
}

void check_features(ParameterCheck& check, std::size_t k, const ShaftStation& s) {
  if (s.groove) {
    const ShaftGroove& g = *s.groove;
    check.positive(station_key(k, "groove.depth"), g.depth, "m");
    check.positive(station_key(k, "groove.radius"), g.radius, "m");
    const double half = groove_half_width(g), room = 0.5 * (0.98 * s.outer_diameter - s.inner_diameter);
    if (g.depth > 0.0 && !(g.depth < 0.9 * room))
      check.fail(station_key(k, "groove.depth"), to_text(g.depth), "m",
                 "must leave a wall: less than " + to_text(0.9 * room));
    const double least = s.fillet_start + half, most = s.length - s.fillet_end - half;
    if (!(g.position > least && g.position < most))
      check.fail(station_key(k, "groove.position"), to_text(g.position), "m",
                 "must leave the groove inside its station, beside its fillets: between " + to_text(least) +
                     " and " + to_text(most));
  }
  if (s.keyway) try_outline(check, k, "keyway", [&] { keyway_of(s); });
  if (s.spline) try_outline(check, k, "spline", [&] { spline_of(s); });
  if (s.cam) try_outline(check, k, "cam", [&] { cam_of(s); });
  if ((s.keyway || s.spline) && s.inner_diameter > 0.0) {
    const double most =
        s.keyway ? 0.3 * (s.outer_diameter - 2.0 * s.keyway->depth) : 0.3 * s.spline->minor_diameter;
    if (s.inner_diameter > most)
      check.fail(station_key(k, "inner_diameter"), to_text(s.inner_diameter), "m",
                 "must be at most 0.3 of what a keyway or spline leaves, " + to_text(most) +
                     ": J is that of the solid section less the bore's");
  }
}

/// Fillets lie on the thinner side of a step and must fit between the station's ends.
void check_fillets(ParameterCheck& check, const ShaftContour& contour, const ContourParts& parts) {
  for (std::size_t k = 0; k < contour.stations.size(); ++k) {
    const ShaftStation& s = contour.stations[k];
    const auto [left, right] = parts.radii(k);
    double taken = 0.0;
    for (const bool end : {false, true}) {
      const double fillet = end ? s.fillet_end : s.fillet_start;
      if (fillet == 0.0) continue;
      const bool outer_end = end ? k + 1 == contour.stations.size() : k == 0;
      const double step = outer_end ? 0.0
                          : end     ? parts.radii(k + 1).first - right
                                    : parts.radii(k - 1).second - left;
      if (!(step > 0.0)) {
        check.fail(station_key(k, end ? "fillet_end" : "fillet_start"), to_text(fillet), "m",
                   "must be 0 where the neighbour is not thicker");
        continue;
      }
      taken += fillet >= step ? std::sqrt(std::max(2.0 * fillet * step - step * step, 0.0)) : fillet;
      const double least = 1e-3 * std::min(step, right);
      if (fillet < least)
        check.fail(station_key(k, end ? "fillet_end" : "fillet_start"), to_text(fillet), "m",
                   "must be 0 (sharp) or at least a thousandth of the step, " + to_text(least));
    }
    if (taken > s.length)
      check.fail(station_key(k, "length"), to_text(s.length), "m",
                 "must hold the fillets at its ends, together " + to_text(taken));
  }
}

/// What can be: proportions that the meshes hold.
void check_proportions(ParameterCheck& check, const ShaftContour& contour) {
  double thickest = 0.0, thinnest = HUGE_VAL, all = 0.0;
  for (const ShaftStation& s : contour.stations) {
    const double end = std::isnan(s.end_diameter) ? s.outer_diameter : s.end_diameter;
    thickest = std::max({thickest, s.outer_diameter, end, std::isnan(s.hub_diameter) ? 0.0 : s.hub_diameter});
    thinnest = std::min({thinnest, s.outer_diameter, end});
    all += s.length;
  }
  for (std::size_t k = 0; k < contour.stations.size(); ++k) {
    const ShaftStation& s = contour.stations[k];
    const double end = std::isnan(s.end_diameter) ? s.outer_diameter : s.end_diameter;
    const double least = std::min(s.outer_diameter, end);
    if (!(s.inner_diameter <= 0.98 * least))
      check.fail(station_key(k, "inner_diameter"), to_text(s.inner_diameter), "m",
                 "must be at most 0.98 of the smallest outer diameter, " + to_text(0.98 * least));
    if (k > 0) {
      const ShaftStation& before = contour.stations[k - 1];
      const double there = std::isnan(before.end_diameter) ? before.outer_diameter : before.end_diameter;
      const double bore = std::max(s.inner_diameter, before.inner_diameter),
                   outer = std::min(s.outer_diameter, there);
      if (!(bore <= 0.98 * outer) && s.inner_diameter <= 0.98 * least &&
          before.inner_diameter <= 0.98 * there)
        check.fail(station_key(k, "inner_diameter"), to_text(bore), "m",
                   "must leave a wall to the station before: at most 0.98 of the smaller outer diameter, " +
                       to_text(0.98 * outer));
    }
    if (s.length < 1e-3 * least)
      check.fail(station_key(k, "length"), to_text(s.length), "m",
                 "must be at least a thousandth of the diameter, " + to_text(1e-3 * least));
    if (s.length > 1e4 * thickest)
      check.fail(station_key(k, "length"), to_text(s.length), "m",
                 "must be at most 10,000 times the largest diameter, " + to_text(1e4 * thickest));
  }
  if (thickest > 50.0 * thinnest)
    check.fail("stations", to_text(thickest), "m",
               "must have diameters within a factor of 50 of the smallest, " + to_text(thinnest));
}

}  // namespace

std::vector<StationSection> check_contour(const ShaftContour& contour, ParameterCheck& check) {
  std::vector<Finding> own;
  std::vector<StationSection> sections;
  ParameterCheck first(check.place(), own);
  first.positive("shear_modulus", contour.shear_modulus, "Pa");
  first.positive("density", contour.density, "kg/m^3");
  first.within("accuracy", contour.accuracy, 1e-6, 0.1, "");
  first.within("frequency_accuracy", contour.frequency_accuracy, 1e-12, 0.1, "");
  if (!std::isnan(contour.up_to_frequency)) first.positive("up_to_frequency", contour.up_to_frequency, "Hz");
  const std::size_t count = contour.stations.size();
  if (count == 0 || count > ShaftContour::kMostStations)
    first.fail("stations", std::to_string(count), "",
               "must be between 1 and " + std::to_string(ShaftContour::kMostStations));
  for (std::size_t k = 0; k < count; ++k) check_numbers(first, k, contour.stations[k]);
  // Further checks compute with numbers that are sound.
  if (own.empty()) {
    check_proportions(first, contour);
    for (std::size_t k = 0; k < count; ++k) check_features(first, k, contour.stations[k]);
  }
  if (own.empty()) try {
      segment_counts(contour);
      sections = station_sections(contour);
      check_fillets(first, contour, ContourParts(contour, sections, ContourVariant::likely));
    } catch (const ModelError& error) {
      for (const Finding& f : error.findings()) first.fail(f.parameter, f.value, f.unit, f.range);
    }
  for (const Finding& f : own) check.fail(f.parameter, f.value, f.unit, f.range);
  return sections;
}

void ShaftContour::check(ParameterCheck& check) const { check_contour(*this, check); }

}  // namespace drev
