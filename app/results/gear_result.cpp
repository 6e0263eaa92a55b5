#include "app/results/gear_result.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <optional>

#include "app/base/text_layout.hpp"
#include "app/base/text_plot.hpp"
#include "app/results/run_json.hpp"
#include "models/gears/analytic_stiffness.hpp"
#include "models/gears/meshed_teeth.hpp"

namespace drev::app {

namespace {

constexpr double kPerWidth = 1e9;  // 1 N/(mm um) in N/m per m of face width
constexpr int kDrawnTeeth = 3, kHarmonics = 10;

std::string in_mm(double metres, int significant = 6) {
  return short_digits(1e3 * metres, significant) + " mm";
}
std::string in_um(double metres, int significant = 4) {
  return short_digits(1e6 * metres, significant) + " um";
}
std::string in_deg(double angle) { return short_digits(angle * 180.0 / kPi, 6) + " deg"; }
bool is_known(double value) { return !std::isnan(value); }

std::string with_error(double value, double error, double scale, const std::string& unit) {
  return earned_digits(value / scale, error / scale) + " +- " + digits(error / scale, 2) + " " + unit;
}

struct Beside {
  double energy, yang_sun, weber;
  IsoStiffness iso;
};

Beside beside(const GearCase& c) {
  const double t = c.data.pair.pitch_point(), w = c.data.cycle.options().load;
  const double at = std::min(std::max(t, c.data.pair.start_of_contact()), c.data.pair.end_of_contact());
  return {analytic_pair_stiffness(c.data.pair, AnalyticMethod::potential_energy, at, w),
          analytic_pair_stiffness(c.data.pair, AnalyticMethod::potential_energy_yang_sun, at, w),
          analytic_pair_stiffness(c.data.pair, AnalyticMethod::weber_banaschek, at, w),
          iso_mesh_stiffness(c.data.pair, w)};
}

std::string per_width(double k) { return digits(k / kPerWidth, 4) + " N/(mm um)"; }

/// Sentence on the stiffness by the potential energy method, up to the next method.
std::string beside_energy(const GearPair& pair, const Beside& other) {
  if (pair.geometry().internal) return "";  // Sainsot's body is a disc
  const std::string method = " by potential energy with Sainsot's body";
  if (!is_known(other.energy)) return "outside its range" + method + ", ";
  return per_width(other.energy) + method + " (" + per_width(other.yang_sun) +
         " with Yang and Sun's contact), ";
}

/// Error of the forces between half and twice the mean load, for an element without given loads, which has
/// the stiffness at the mean load. nullopt where loads are given, or where the teeth cannot carry that much.
std::optional<LoadLawError> mean_load_error(const GearCase& c) {
  if (c.data.load_law || c.drawing.tangent) return std::nullopt;
  const double w = c.data.cycle.options().load;
  try {
    return gear_load_law(c.data.cycle, {0.5 * w, w, 2.0 * w}).constant;
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

double unloaded_range(const MeshCycle& cycle) {
  double low = INFINITY, high = -INFINITY;
  for (const MeshPoint& p : cycle.points())
    low = std::min(low, p.unloaded_error), high = std::max(high, p.unloaded_error);
  return high - low;
}

PlotLine curve(const MeshCycle& cycle, double MeshPoint::*value, double scale, char mark) {
  PlotLine line{mark, {}};
  for (const MeshPoint& p : cycle.points()) line.points.push_back({p.phase, p.*value / scale});
  return line;
}

Json outline(const Outline& line) {
  Json x = Json::array(), y = Json::array();
  for (const auto& p : line) x.push_back(number(p[0])), y.push_back(number(p[1]));
  return {{"x_m", std::move(x)}, {"y_m", std::move(y)}};
}

Json points(const MeshCycle& cycle, double MeshPoint::*value) {
  Json list = Json::array();
  for (const MeshPoint& p : cycle.points()) list.push_back(number(p.*value));
  return list;
}

Json estimated(double value, double error) { return {{"value", number(value)}, {"error", number(error)}}; }

Json gear_data(const GearCase& c, int gear) {
  const ToothContour& t = c.data.pair.contour(gear);
  const GearData& g = c.data.pair.gear(gear);
  return {{"teeth", g.teeth},
          {"profile_shift", number(g.profile_shift)},
          {"pitch_diameter_m", number(2.0 * t.pitch_radius())},
          {"base_diameter_m", number(2.0 * t.base_radius())},
          {"root_diameter_m", number(2.0 * t.root_radius())},
          {"tip_diameter_m", number(g.tip_diameter)},
          {"form_diameter_m", number(2.0 * t.flank(t.form_length()).radius)},
          {"bore_diameter_m", number(g.bore_diameter)},
          {"outer_diameter_m", number(g.outer_diameter)},
          {"width_m", number(g.width)},
          {"inertia_kg_m2", number(c.data.pair.inertia(gear))},
          {"outline", outline(meshed_teeth(c.data.pair, gear, kDrawnTeeth))}};
}

Json law_error(const LoadLawError& e) { return {{"rms", number(e.rms)}, {"most", number(e.most)}}; }

/// Stiffness over load; null where the stiffness is that at the mean load alone.
Json load_law_data(const GearCase& c) {
  if (!c.data.load_law) return nullptr;
  const GearLoadLaw& law = *c.data.load_law;
  const auto list = [](const std::vector<double>& values) {
    Json all = Json::array();
    for (const double value : values) all.push_back(number(value));
    return all;
  };
  return {{"loads_N_per_m", list(law.loads)}, {"penetrations_m", list(law.penetrations)},
          {"slopes", list(law.slopes)},       {"stiffness_N_per_m2", list(law.stiffness)},
          {"error", law_error(law.error)},    {"error_of_constant", law_error(law.constant)}};
}

Json pair_data(const GearCase& c) {
  const GearPair& pair = c.data.pair;
  const MeshCycle& cycle = c.data.cycle;
  const MeshFigures &f = cycle.figures(), &e = cycle.errors();
  const Beside other = beside(c);
  const std::optional<LoadLawError> mean_load = mean_load_error(c);
  Json harmonics = Json::array();
  for (const Harmonic& h : cycle.harmonics(kHarmonics))
    harmonics.push_back({{"order", number(h.order)},
                         {"amplitude_N_per_m2", number(h.amplitude)},
                         {"phase_rad", number(h.phase)}});
  Json shares = Json::array();
  for (std::size_t k = 0; k < 3; ++k) {
    Json one = Json::array();
    for (const MeshPoint& p : cycle.points()) one.push_back(number(p.shares[k]));
    shares.push_back(std::move(one));
  }
  return {{"name", c.name},
          {"gears", Json::array({gear_data(c, 0), gear_data(c, 1)})},
          {"centre_distance_m", number(pair.centre_distance())},
          {"zero_backlash_distance_m", number(pair.zero_backlash_distance())},
          {"operating_angle_rad", number(pair.operating_angle())},
          {"base_pitch_m", number(pair.base_pitch())},
          {"contact_ratio", number(pair.contact_ratio())},
          {"overlap_ratio", number(pair.overlap_ratio())},
          {"flank_contact_ratio", number(pair.flank_contact_ratio())},
          {"backlash_m",
           {{"lowest", number(c.data.backlash.lowest())},
            {"highest", number(c.data.backlash.highest())},
            {"percentile", number(c.data.backlash.percentile(c.drawing.backlash_percentile))}}},
          {"face_width_m", number(pair.face_width())},
          {"load_N_per_m", number(cycle.options().load)},
          {"single_pair_N_per_m2", estimated(f.single_pair, e.single_pair)},
          {"mean_N_per_m2", estimated(f.mean, e.mean)},
          {"tangent_mean_N_per_m2", estimated(f.tangent_mean, e.tangent_mean)},
          {"highest_N_per_m2", estimated(f.highest, e.highest)},
          {"lowest_N_per_m2", estimated(f.lowest, e.lowest)},
          {"loaded_error_mean_m", estimated(f.error_mean, e.error_mean)},
          {"loaded_error_range_m", estimated(f.error_peak_to_peak, e.error_peak_to_peak)},
          {"loaded_contact_ratio", number(f.loaded_contact_ratio)},
          {"load_law", load_law_data(c)},
          {"mean_load_error", mean_load ? law_error(*mean_load) : Json(nullptr)},
          {"beside",
           {{"potential_energy_N_per_m2", number(other.energy)},
            {"yang_sun_N_per_m2", number(other.yang_sun)},
            {"weber_banaschek_N_per_m2", number(other.weber)},
            {"iso_single_N_per_m2", number(other.iso.single)},
            {"iso_mesh_N_per_m2", number(other.iso.mesh)},
            {"iso_outside", text_or_null(other.iso.outside)}}},
          {"harmonics", std::move(harmonics)},
          {"curve",
           {{"phase", points(cycle, &MeshPoint::phase)},
            {"secant_N_per_m2", points(cycle, &MeshPoint::secant)},
            {"tangent_N_per_m2", points(cycle, &MeshPoint::tangent)},
            {"loaded_error_m", points(cycle, &MeshPoint::loaded_error)},
            {"unloaded_error_m", points(cycle, &MeshPoint::unloaded_error)},
            {"pairs", points(cycle, &MeshPoint::pairs)},
            {"shares", std::move(shares)}}},
          {"path_of_contact", outline(path_of_contact(pair))},
          {"conventions", gear_conventions(c)}};
}

}  // namespace

std::vector<std::vector<std::string>> gear_dimensions(const GearCase& c) {
  std::vector<std::vector<std::string>> rows{{"", "gear 1", "gear 2"}};
  const auto row = [&](const std::string& name, auto value) { rows.push_back({name, value(0), value(1)}); };
  const GearPair& p = c.data.pair;
  row("teeth", [&](int i) { return std::to_string(p.gear(i).teeth); });
  row("profile shift", [&](int i) { return short_digits(p.gear(i).profile_shift, 6); });
  row("pitch diameter", [&](int i) { return in_mm(2.0 * p.contour(i).pitch_radius()); });
  row("base diameter", [&](int i) { return in_mm(2.0 * p.contour(i).base_radius()); });
  row("tip diameter", [&](int i) { return in_mm(p.gear(i).tip_diameter); });
  row("root diameter", [&](int i) { return in_mm(2.0 * p.contour(i).root_radius()); });
  row("form diameter",
      [&](int i) { return in_mm(2.0 * p.contour(i).flank(p.contour(i).form_length()).radius); });
  row("held at the diameter", [&](int i) { return in_mm(2.0 * p.held_radius(i)); });
  row("moment of inertia", [&](int i) { return short_digits(p.inertia(i), 5) + " kg m^2"; });
  return rows;
}

std::vector<GearRow> gear_rows(const GearCase& c) {
  const GearPair& p = c.data.pair;
  const MeshCycle& cycle = c.data.cycle;
  const MeshFigures &f = cycle.figures(), &e = cycle.errors();
  const Backlash& b = c.data.backlash;
  const Beside other = beside(c);
  const std::string unit = "N/(mm um)";
  std::vector<GearRow> rows{
      {"Centre distance",
       in_mm(p.centre_distance(), 9) + "; " + in_mm(p.zero_backlash_distance(), 9) + " without backlash"},
      {"Operating angle", in_deg(p.operating_angle()) + ", base pitch " + in_mm(p.base_pitch(), 8)},
      {"Contact ratio", digits(p.contact_ratio(), 5) + " transverse, " + short_digits(p.overlap_ratio(), 4) +
                            " overlap; the flanks allow " + digits(p.flank_contact_ratio(), 5) + "; " +
                            digits(f.loaded_contact_ratio, 4) + " pairs carry on the mean under load"},
      {"Backlash", in_um(b.lowest()) + " to " + in_um(b.highest()) + " along the line of action; " +
                       short_digits(100.0 * c.drawing.backlash_percentile, 4) +
                       " % of all pairs have at most " + in_um(b.percentile(c.drawing.backlash_percentile))},
      {"Load", short_digits(1e-3 * cycle.options().load, 5) + " N/mm of width, " +
                   short_digits(cycle.options().load * p.face_width() * p.contour(0).base_radius(), 5) +
                   " N m on gear 1"},
      {"One pair, pitch point", with_error(f.single_pair, e.single_pair, kPerWidth, unit)},
      {"Mesh stiffness, mean", with_error(f.mean, e.mean, kPerWidth, unit) + "; " +
                                   short_digits(f.mean * p.face_width(), 4) + " N/m over the width of " +
                                   in_mm(p.face_width())},
      {"  lowest, highest", with_error(f.lowest, e.lowest, kPerWidth, unit) + ", " +
                                with_error(f.highest, e.highest, kPerWidth, unit)},
      {"  tangent, mean", with_error(f.tangent_mean, e.tangent_mean, kPerWidth, unit)},
      {"Transmission error", "loaded " + with_error(f.error_mean, e.error_mean, 1e-6, "um") +
                                 " on the mean, " +
                                 with_error(f.error_peak_to_peak, e.error_peak_to_peak, 1e-6, "um") +
                                 " peak to peak; unloaded " + in_um(unloaded_range(cycle)) + " peak to peak"},
      {"Beside: one pair", beside_energy(p, other) + per_width(other.weber) + " by Weber and Banaschek, " +
                               per_width(other.iso.single) + " by ISO 6336-1"},
      {"Beside: mean",
       per_width(other.iso.mesh) + " by ISO 6336-1" +
           (other.iso.outside.empty() ? "" : ", outside its validity: " + other.iso.outside)}};
  const auto off = [](const LoadLawError& e) {
    return digits(100.0 * e.rms, 2) + " % (rms), " + digits(100.0 * e.most, 2) + " % at most";
  };
  if (const auto error = mean_load_error(c))
    rows.push_back({"Stiffness of this load", "between half and twice of it the element's force is off by " +
                                                  off(*error) + "; loads make it follow"});
  if (c.data.load_law) {
    const GearLoadLaw& law = *c.data.load_law;
    rows.push_back({"Stiffness with the load",
                    short_digits(1e-3 * law.loads.front(), 5) + " to " +
                        short_digits(1e-3 * law.loads.back(), 5) + " N/mm: the element's force is off by " +
                        off(law.error) + "; with the stiffness of the mean load by " + off(law.constant)});
  }
  return rows;
}

std::vector<std::string> gear_conventions(const GearCase& c) {
  const MeshCycleOptions& o = c.data.cycle.options();
  return {
      "Stiffness along the transverse line of action per width, secant at the load stated; it follows the "
      "load.",
      std::string("Bodies in plane strain, held at ") +
          (c.data.pair.geometry().internal ? "the bore of gear 1 and the outside of the ring"
                                           : "their bores") +
          (o.windup ? ": the windup of the discs is part of the mesh."
                    : ", the windup of the discs taken out."),
      "Pairs share the load through the compliance of both bodies; contact by Hertz's line contact; no "
      "friction.",
      o.corner_contact ? "Tips touch before A and behind E where deflections bring it about."
                       : "No contact outside the path from A to E.",
      "Errors are those of the finite-element mesh alone, estimated from a coarser one."};
}

std::string gear_as_text(const std::vector<GearCase>& cases) {
  std::string text;
  for (const GearCase& c : cases) {
    const MeshCycle& cycle = c.data.cycle;
    text += (text.empty() ? "" : "\n") + c.name + ": module " + in_mm(c.data.pair.geometry().module) +
            ", pressure angle " + in_deg(c.data.pair.geometry().pressure_angle) + ", helix angle " +
            in_deg(c.data.pair.geometry().helix_angle) + "\n\n" + columns_text(gear_dimensions(c)) + "\n";
    for (const GearRow& row : gear_rows(c)) text += labelled(row.name, row.value);
    text += "\nTooth pair in mesh (1, 2: the gears; =: path of contact)\n" +
            text_plot({{'1', meshed_teeth(c.data.pair, 0, kDrawnTeeth)},
                       {'2', meshed_teeth(c.data.pair, 1, kDrawnTeeth)},
                       {'=', path_of_contact(c.data.pair)}},
                      96, 30, true);
    text += "\nMesh stiffness [N/(mm um)] over the mesh phase (*: secant, .: tangent)\n" +
            text_plot({curve(cycle, &MeshPoint::tangent, kPerWidth, '.'),
                       curve(cycle, &MeshPoint::secant, kPerWidth, '*')},
                      80, 14);
    text += "\nTransmission error [um] over the mesh phase (*: loaded, .: unloaded)\n" +
            text_plot({curve(cycle, &MeshPoint::unloaded_error, 1e-6, '.'),
                       curve(cycle, &MeshPoint::loaded_error, 1e-6, '*')},
                      80, 12) +
            "\n";
    for (const std::string& sentence : gear_conventions(c)) text += wrap(sentence, 2);
  }
  return text;
}

Json gear_object(const std::string& file, const std::vector<GearCase>& cases) {
  Json pairs = Json::array();
  for (const GearCase& c : cases) pairs.push_back(pair_data(c));
  Json object = result_object("gear");
  object["file"] = file;
  object["pairs"] = std::move(pairs);
  return object;
}

}  // namespace drev::app
