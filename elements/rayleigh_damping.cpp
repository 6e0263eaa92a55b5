#include <drev/core/element.hpp>
#include <drev/elements/rayleigh_damping.hpp>

namespace drev {

namespace {

void check_mode(ParameterCheck& check, std::string_view suffix, double omega, double xi) {
  check.positive("omega" + std::string(suffix), omega, "rad/s");
  check.non_negative("xi" + std::string(suffix), xi, "");
}

}  // namespace

RayleighDamping::Params RayleighDamping::from_two_modes(double omega_1, double xi_1, double omega_2,
                                                        double xi_2) {
  std::vector<Finding> findings;
  ParameterCheck check("Rayleigh damping from two modes", findings);
  check_mode(check, "_1", omega_1, xi_1);
  check_mode(check, "_2", omega_2, xi_2);
  if (omega_1 == omega_2) check.fail("omega_2", to_text(omega_2), "rad/s", "must differ from omega_1");
  if (!findings.empty()) throw ModelError(std::move(findings));

  const double difference = (omega_2 - omega_1) * (omega_2 + omega_1);
  const Params p{.alpha_mass = 2.0 * omega_1 * omega_2 * (xi_1 * omega_2 - xi_2 * omega_1) / difference,
                 .beta_stiffness = 2.0 * (xi_2 * omega_2 - xi_1 * omega_1) / difference};
  const char* range = "must be >= 0; xi_2/xi_1 must lie between omega_1/omega_2 and its inverse";
  if (p.alpha_mass < 0.0) check.fail("alpha_mass", to_text(p.alpha_mass), "1/s", range);
  if (p.beta_stiffness < 0.0) check.fail("beta_stiffness", to_text(p.beta_stiffness), "s", range);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return p;
}

RayleighDamping::Params RayleighDamping::mass_proportional(double omega, double xi) {
  std::vector<Finding> findings;
  ParameterCheck check("Rayleigh damping from one mode", findings);
  check_mode(check, "", omega, xi);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {.alpha_mass = 2.0 * xi * omega};
}

RayleighDamping::Params RayleighDamping::stiffness_proportional(double omega, double xi) {
  std::vector<Finding> findings;
  ParameterCheck check("Rayleigh damping from one mode", findings);
  check_mode(check, "", omega, xi);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {.beta_stiffness = 2.0 * xi / omega};
}

void RayleighDamping::check(ParameterCheck& check) const {
  check.non_negative("alpha_mass", params_.alpha_mass, "1/s");
  check.non_negative("beta_stiffness", params_.beta_stiffness, "s");
}

void RayleighDamping::describe(int /*nodes*/, Terms& terms) const {
  terms.rayleigh_a = params_.alpha_mass;
  terms.rayleigh_b = params_.beta_stiffness;
}

}  // namespace drev
