#include "app/results/shaft_result.hpp"

#include <algorithm>
#include <cmath>

#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/run_json.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kDrawnWide = 96, kDrawnHigh = 9;
constexpr double kMilli = 1e3;

std::string factor_text(const Estimate& factor) {
  return std::isinf(factor.value) ? "no limit" : earned_digits(factor.value, factor.error);
}

/// Drawing of the upper half of the contour over z, and below it tau over its largest value in tenths.
std::string drawing(const ShaftSections& s) {
  const double length = s.outline_z.back(), most = *std::max_element(s.outline_r.begin(), s.outline_r.end());
  const double peak = *std::max_element(s.outline_stress.begin(), s.outline_stress.end());
  const auto at = [&](std::size_t column) { return column * (s.outline_z.size() - 1) / (kDrawnWide - 1); };
  std::string text;
  for (std::size_t row = kDrawnHigh; row-- > 0;) {
    std::string line;
    for (std::size_t column = 0; column < kDrawnWide; ++column)
      line += s.outline_r[at(column)] > most * (double(row) + 0.5) / double(kDrawnHigh) ? '#' : ' ';
    text += "  " + line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  std::string tenths;
  for (std::size_t column = 0; column < kDrawnWide; ++column)
    tenths += static_cast<char>('0' + static_cast<int>(9.999 * s.outline_stress[at(column)] / peak));
  return text + "  " + tenths + "\n  " + std::string(kDrawnWide, '-') + "\n  Axis: 0 to " +
         digits(kMilli * length, 5) + " mm; radius to " + digits(kMilli * most, 4) +
         " mm. Digits: nominal shear stress on the surface, in tenths of its largest, " +
         digits(1e-6 * peak, 4) + " MPa per N m.\n";
}

std::string stations_text(const ShaftSections& s) {
  std::vector<std::vector<std::string>> rows{{"station", "from [mm]", "length", "d [mm]", "bore", "J [mm^4]",
                                              "J alone kNm/rad", "in the shaft", "inertia [kg m^2]",
                                              "stress factor", "at"}};
  for (const ShaftSection& section : s.sections)
    rows.push_back({section.name, digits(kMilli * section.from, 5), digits(kMilli * section.length, 5),
                    digits(kMilli * section.diameter, 5), digits(kMilli * section.bore, 4),
                    digits(1e12 * section.torsion_constant, 6),
                    digits(1e-3 * s.shear_modulus / section.naive_flexibility, 5),
                    digits(1e-3 * s.shear_modulus / section.flexibility, 5), digits(section.inertia, 5),
                    factor_text(section.stress_factor), section.stress_place});
  return columns_text(rows);
}

std::string shaft_text(const PlacedShaft& shaft) {
  const ShaftSections& s = *shaft.element->sections();
  const double error = s.stiffness() * s.flexibility.error / s.flexibility.value;
  std::string text = shaft.name + ", " + shaft.from_node + " to " + shaft.to_node + ": " +
                     std::to_string(s.sections.size()) + " stations, " +
                     std::to_string(s.segment_inertia.size()) + " segments\n\n" + drawing(s) + "\n";
  text += labelled("torsional stiffness", earned_digits(s.stiffness(), error) + " N m/rad +- " +
                                              digits(error, 2) + " of the mesh (" +
                                              std::to_string(s.unknowns) + " unknowns)");
  text += labelled("sum of its stations", digits(s.shear_modulus / s.naive_flexibility, 6) +
                                              " N m/rad: " + digits(100.0 * s.naive_excess(), 3) +
                                              " % too stiff, each with its own J over its length");
  const ShaftBounds bounds = shaft_bounds(shaft.element->params());
  if (bounds.stiffest > bounds.softest * (1.0 + 1e-9))
    text += labelled("bounds",
                     digits(bounds.softest, 5) + " to " + digits(bounds.stiffest, 5) +
                         " N m/rad: cams and splines as inscribed and circumscribed circles, hubs loose and "
                         "as one with the shaft");
  text += labelled("inertia", digits(s.inertia(), 6) + " kg m^2");
  return text + "\n" + stations_text(s);
}

Json shaft_object(const PlacedShaft& shaft) {
  const ShaftSections& s = *shaft.element->sections();
  const ShaftBounds bounds = shaft_bounds(shaft.element->params());
  Json stations = Json::array(), segments = Json::array();
  for (const ShaftSection& section : s.sections)
    stations.push_back({{"name", section.name},
                        {"from_m", section.from},
                        {"length_m", section.length},
                        {"diameter_m", section.diameter},
                        {"bore_m", section.bore},
                        {"torsion_constant_m4", section.torsion_constant},
                        {"own_stiffness_Nm_per_rad", s.shear_modulus / section.naive_flexibility},
                        {"stiffness_Nm_per_rad", s.shear_modulus / section.flexibility},
                        {"inertia_kg_m2", section.inertia},
                        {"stress_factor", number(section.stress_factor.value)},
                        {"stress_factor_error", section.stress_factor.error},
                        {"stress_place", section.stress_place}});
  for (std::size_t k = 0; k < s.segment_inertia.size(); ++k)
    segments.push_back({{"from_m", s.planes[k]},
                        {"to_m", s.planes[k + 1]},
                        {"stiffness_Nm_per_rad", s.shear_modulus / s.segment_flexibility[k]},
                        {"inertia_kg_m2", s.segment_inertia[k]},
                        {"station", s.segment_station[k] + 1}});
  return {{"name", shaft.name},
          {"nodes", {shaft.from_node, shaft.to_node}},
          {"stiffness_Nm_per_rad", s.stiffness()},
          {"stiffness_error_Nm_per_rad", s.stiffness() * s.flexibility.error / s.flexibility.value},
          {"naive_stiffness_Nm_per_rad", s.shear_modulus / s.naive_flexibility},
          {"naive_excess", s.naive_excess()},
          {"softest_Nm_per_rad", bounds.softest},
          {"stiffest_Nm_per_rad", bounds.stiffest},
          {"inertia_kg_m2", s.inertia()},
          {"unknowns", s.unknowns},
          {"stations", std::move(stations)},
          {"segments", std::move(segments)},
          {"outline",
           {{"z_m", numbers(s.outline_z)},
            {"radius_m", numbers(s.outline_r)},
            {"stress_Pa_per_Nm", numbers(s.outline_stress)}}}};
}

}  // namespace

std::vector<PlacedShaft> contour_shafts(const Model& model) {
  std::vector<PlacedShaft> shafts;
  for (const ElementInstance& placement : model.element_instances())
    if (const auto* shaft = dynamic_cast<const ContourShaft*>(placement.element.get()))
      shafts.push_back(
          {placement.name, model.name_of(placement.nodes[0]), model.name_of(placement.nodes[1]), shaft});
  return shafts;
}

std::string shafts_as_text(const ModelRequest& request, const std::vector<PlacedShaft>& shafts) {
  const std::string& name = request.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.parameters), name.size() + 2);
  for (const PlacedShaft& shaft : shafts) text += "\n" + shaft_text(shaft);
  return text;
}

Json shafts_object(const ModelRequest& request, const std::vector<PlacedShaft>& shafts) {
  Json object = result_object("shaft");
  object["model"] = request.entry->name;
  object["parameters"] = parameters_object(request.parameters);
  object["shafts"] = Json::array();
  for (const PlacedShaft& shaft : shafts) object["shafts"].push_back(shaft_object(shaft));
  object["note"] = text_or_null(request.model_case.note);
  return object;
}

}  // namespace drev::app
