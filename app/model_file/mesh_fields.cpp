#include <drev/elements/involute.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

#include "app/model_file/shared_fields.hpp"

namespace drev::app {

namespace {

using D = Dimension;

/// The contact ratio, or the gears that it follows from.
void list_contact_ratio(Fields& f, double& ratio) {
  f.number({"contact_ratio", D::none}, ratio);
  if (!f.reading()) return;
  int given = std::isnan(ratio) ? 0 : 1;
  const auto from = [&](const std::function<double()>& involute) {
    ++given;
    f.guarded([&] { ratio = involute(); });
  };
  InvolutePair pair{kNotGiven, kNotGiven, kNotGiven, kNotGiven, kNotGiven, 0};
  if (f.group("gears", [&](Fields& g) {
        g.number({"base_radius_1", D::length}, pair.base_radius_1, Need::required);
        g.number({"tip_radius_1", D::length}, pair.tip_radius_1, Need::required);
        g.number({"base_radius_2", D::length}, pair.base_radius_2, Need::required);
        g.number({"tip_radius_2", D::length}, pair.tip_radius_2, Need::required);
        g.number({"centre_distance", D::length}, pair.centre_distance, Need::required);
        g.whole("teeth_1", pair.teeth_1, Need::required);
      }))
    from([&] { return involute_contact_ratio(pair); });
  int teeth_1 = 0, teeth_2 = 0;
  double angle = kNotGiven, addendum = 1.0;
  if (f.group("standard_gears", [&](Fields& g) {
        g.whole("teeth_1", teeth_1, Need::required);
        g.whole("teeth_2", teeth_2, Need::required);
        g.number({"pressure_angle", D::angle}, angle, Need::required);
        g.number({"addendum", D::none}, addendum);
      }))
    from([&] { return involute_contact_ratio(1.0, teeth_1, teeth_2, angle, addendum); });
  if (given != 1) f.fault("needs exactly one of contact_ratio, gears and standard_gears");
}

void list_stiffness(Fields& f, MeshStiffness& stiffness) {
  const Quantity along("stiffness", D::stiffness), mean("mean", D::stiffness);
  const Quantity single("single", D::stiffness), both("double", D::stiffness);
  const Quantity amplitude("amplitude", D::stiffness), phase("phase", D::mesh_periods);
  const MeshStiffness::Law& law = stiffness.law();
  double k = kNotGiven;
  MeshStiffness::Step step{kNotGiven, kNotGiven, kNotGiven};
  MeshStiffness::Fourier series{kNotGiven, {}};
  PeriodicTable table;
  if (const auto* constant = std::get_if<double>(&law)) k = *constant;
  if (const auto* held = std::get_if<MeshStiffness::Step>(&law)) step = *held;
  if (const auto* held = std::get_if<MeshStiffness::Fourier>(&law)) series = *held;
  if (const auto* held = std::get_if<PeriodicTable>(&law)) table = *held;
  const bool read = f.reading();
  const auto list_step = [&](Fields& g) {
    g.number(single, step.single, Need::required);
    g.number(both, step.both, Need::required);
    list_contact_ratio(g, step.contact_ratio);
  };
  int given = 0;
  if (read || std::holds_alternative<double>(law)) {
    f.number(along, k);
    if (!std::isnan(k)) ++given, stiffness = MeshStiffness(k);
  }
  if ((read || std::holds_alternative<MeshStiffness::Step>(law)) && f.group("stiffness_step", list_step))
    ++given, stiffness = MeshStiffness::step(step.single, step.both, step.contact_ratio);
  if ((read || std::holds_alternative<MeshStiffness::Fourier>(law)) &&
      f.group("stiffness_fourier", [&](Fields& g) {
        g.number(mean, series.mean, Need::required);
        list_harmonics(g, "harmonics", Quantity("order", D::none), amplitude, series.harmonics);
      }))
    ++given, stiffness = MeshStiffness::fourier(series.mean, series.harmonics);
  int harmonics = 10;
  if (read && f.group("stiffness_fourier_of_step", [&](Fields& g) {
        list_step(g);
        g.whole("harmonics", harmonics);
        if (harmonics < 1 || harmonics > 1000) g.fault("harmonics must be from 1 to 1000");
      }))
    ++given,
        stiffness = MeshStiffness::fourier_of_step(step.single, step.both, step.contact_ratio, harmonics);
  if ((read || std::holds_alternative<PeriodicTable>(law)) &&
      list_periodic(f, "stiffness_table", phase, along, 1.0, table))
    ++given, stiffness = MeshStiffness::table(table.arguments(), table.values());
  if (read && given != 1)
    f.fault("needs exactly one of " + spellings("stiffness", D::stiffness) +
            ", stiffness_step, stiffness_fourier, stiffness_fourier_of_step and stiffness_table");
}

void list_error(Fields& f, TransmissionError& error) {
  const Quantity amplitude("amplitude", D::length), phase("phase", D::mesh_periods), e("error", D::length);
  std::vector<Harmonic> harmonics;
  PeriodicTable table;
  if (const auto* held = std::get_if<std::vector<Harmonic>>(&error.law())) harmonics = *held;
  if (const auto* held = std::get_if<PeriodicTable>(&error.law())) table = *held;
  const bool by_table = std::holds_alternative<PeriodicTable>(error.law());
  const bool first =
      list_harmonics(f, "transmission_error", Quantity("order", D::none), amplitude, harmonics);
  if (first) error = TransmissionError(harmonics);
  if ((f.reading() || by_table) && list_periodic(f, "transmission_error_table", phase, e, 1.0, table)) {
    error = TransmissionError::table(table.arguments(), table.values());
    if (first) f.fault("has transmission_error and transmission_error_table; give one of them");
  }
}

}  // namespace

void list(Fields& f, GearMesh::Params& p) {
  static const std::vector<std::string> laws{"proportional", "limited", "contact_only", "always"};
  f.number({"base_radius_1", D::length}, p.base_radius_1);
  f.number({"base_radius_2", D::length}, p.base_radius_2);
  f.number({"module", D::length}, p.module);
  f.whole("teeth_1", p.teeth_1);
  f.whole("teeth_2", p.teeth_2);
  f.number({"pressure_angle", D::angle}, p.pressure_angle);
  f.flag("internal", p.internal);
  list_stiffness(f, p.stiffness);
  f.number({"normal_backlash", D::length}, p.normal_backlash);
  f.number({"damping", D::damping}, p.damping);
  int law = static_cast<int>(p.damping_law);
  f.choice("damping_law", laws, law);
  p.damping_law = static_cast<MeshDamping>(law);
  f.number({"reference_penetration", D::length}, p.reference_penetration);
  list_error(f, p.transmission_error);
  f.number({"mesh_phase", D::mesh_periods}, p.mesh_phase);
}

}  // namespace drev::app
