#include <drev/core/element.hpp>
#include <drev/elements/couplings/torsional_damper.hpp>

namespace drev {

double FluidFilm::damping() const {
  const double o = outer_radius, i = inner_radius;
  double sum = 0.0;
  if (side_gap > 0.0) sum += (o * o * o * o - i * i * i * i) / side_gap;
  if (outer_gap > 0.0) sum += 2.0 * width * o * o * o / outer_gap;
  if (inner_gap > 0.0) sum += 2.0 * width * i * i * i / inner_gap;
  return kPi * viscosity * sum;
}

void FluidFilm::check(ParameterCheck& check) const {
  check.positive("film.viscosity", viscosity, "Pa s");
  check.positive("film.outer_radius", outer_radius, "m");
  check.non_negative("film.inner_radius", inner_radius, "m");
  check.positive("film.width", width, "m");
  check.non_negative("film.side_gap", side_gap, "m");
  check.non_negative("film.outer_gap", outer_gap, "m");
  check.non_negative("film.inner_gap", inner_gap, "m");
  if (inner_radius >= outer_radius)
    check.fail("film.inner_radius", to_text(inner_radius), "m",
               "must be less than the outer radius, " + to_text(outer_radius));
  if (side_gap == 0.0 && outer_gap == 0.0 && inner_gap == 0.0)
    check.fail("film.side_gap", "0", "m", "at least one gap must be > 0");
}

TorsionalDamper::TorsionalDamper(Params params) : params_(std::move(params)) {
  const Params& p = params_;
  ViscoelasticStiffness::Params spring = p.spring;
  if (!std::isnan(p.natural_frequency)) {
    const double omega = kTwoPi * p.natural_frequency;
    spring.stiffness = p.ring_inertia * omega * omega;
  }
  if (sprung()) {
    spring_ = ViscoelasticStiffness(spring);
    stiffness_ = spring_.at(1.0).real();
  }
  damping_ = p.film                        ? p.film->damping()
             : std::isnan(p.damping_ratio) ? p.damping
                                           : 2.0 * p.damping_ratio * std::sqrt(stiffness_ * p.ring_inertia);
}

void TorsionalDamper::check(ParameterCheck& check) const {
  const Params& p = params_;
  check.non_negative("hub_inertia", p.hub_inertia, "kg m^2");
  check.positive("ring_inertia", p.ring_inertia, "kg m^2");
  check.non_negative("damping", p.damping, "N m s/rad");
  if (!std::isnan(p.natural_frequency)) {
    check.positive("natural_frequency", p.natural_frequency, "Hz");
    if (!std::isnan(p.spring.stiffness) || !p.spring.frequencies.empty())
      check.fail("natural_frequency", to_text(p.natural_frequency), "Hz",
                 "must not be given together with a stiffness; give one of them");
  }
  const bool ratio = !std::isnan(p.damping_ratio);
  if (ratio) check.non_negative("damping_ratio", p.damping_ratio, "");
  if (int(ratio) + int(p.damping != 0.0) + int(p.film.has_value()) > 1)
    check.fail("damping", "given twice", "", "give one of damping, damping_ratio and film");
  if (ratio && !sprung())
    check.fail("damping_ratio", to_text(p.damping_ratio), "", "needs a stiffness or a natural frequency");
  if (p.film) p.film->check(check);
  if (sprung()) {
    spring_.check(check);
  } else {
    if (p.spring.loss_factor != 0.0)
      check.fail("loss_factor", to_text(p.spring.loss_factor), "",
                 "needs a stiffness or a natural frequency");
    if (!(damping_ > 0.0))
      check.fail("damping", to_text(damping_), "N m s/rad",
                 "must be > 0 in a damper without spring: nothing else would turn the ring");
  }
}

void TorsionalDamper::describe(int nodes, Terms& terms) const {
  terms.mass(0, 0) += params_.hub_inertia;
  terms.mass(1, 1) += params_.ring_inertia;
  LocalRow b = LocalRow::Zero(nodes);
  b[0] = -1.0;
  b[1] = 1.0;
  if (sprung()) {
    spring_.describe(b, 2, damping_, terms);
    terms.speed_ratio_constraints.push_back({.b = b});
    return;
  }
  terms.damping += damping_ * b * b.transpose();
  terms.speed_ratio_constraints.push_back({.b = b, .ratio_only = true});
  terms.outputs.push_back(
      {.suffix = "", .stiffness = LocalRow::Zero(nodes), .damping = damping_ * b, .deflection = b});
}

}  // namespace drev
