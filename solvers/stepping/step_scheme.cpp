#include <drev/core/error.hpp>
#include <drev/solvers/stepping/butcher_tableau.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <charconv>
#include <cmath>

namespace drev {

namespace {

void throw_if_any(const std::vector<Finding>& findings) {
  if (!findings.empty()) throw ModelError(findings);
}

std::vector<double> numbers(const std::string& text, const std::string& list) {
  std::vector<double> values;
  const char* at = list.data();
  const char* end = at + list.size();
  while (true) {
    double value = 0.0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec != std::errc{} || (result.ptr != end && *result.ptr != ','))
      throw ModelError(
          {{"method", "parameters", text, "", "must be numbers separated by commas, after a colon"}});
    values.push_back(value);
    if (result.ptr == end) return values;
    at = result.ptr + 1;
  }
}

}  // namespace

StepScheme newmark(double beta, double gamma) {
  std::vector<Finding> findings;
  ParameterCheck check("newmark", findings);
  check.within("beta", beta, 0.0, 1e3, "");
  check.within("gamma", gamma, 0.5, 1e3, "");
  throw_if_any(findings);
  return {"newmark:" + to_text(beta) + "," + to_text(gamma), 0.0, 0.0, beta, gamma};
}

StepScheme average_acceleration() { return {"average_acceleration", 0.0, 0.0, 0.25, 0.5}; }

StepScheme hht(double alpha) {
  std::vector<Finding> findings;
  ParameterCheck("hht", findings).within("alpha", alpha, 0.0, 1.0 / 3.0, "");
  throw_if_any(findings);
  return {"hht:" + to_text(alpha), 0.0, alpha, 0.25 * (1 + alpha) * (1 + alpha), 0.5 + alpha};
}

StepScheme generalized_alpha(double rho_inf) {
  std::vector<Finding> findings;
  ParameterCheck("generalized_alpha", findings).within("rho_inf", rho_inf, 0.0, 1.0, "");
  throw_if_any(findings);
  const double alpha_m = (2 * rho_inf - 1) / (rho_inf + 1), alpha_f = rho_inf / (rho_inf + 1);
  const double g = 1 - alpha_m + alpha_f;
  return {"generalized_alpha:" + to_text(rho_inf), alpha_m, alpha_f, 0.25 * g * g, 0.5 - alpha_m + alpha_f};
}

StepScheme runge_kutta(ButcherTableau tableau) {
  const double g = tableau.diagonal();
  const std::string name = tableau.name;
  return {name, 0.0, 0.0, g * g, g, std::make_shared<const ButcherTableau>(std::move(tableau))};
}

StepScheme bathe(double rho_inf) {
  std::vector<Finding> findings;
  ParameterCheck("bathe", findings).within("rho_inf", rho_inf, 0.0, 1.0, "");
  throw_if_any(findings);
  return runge_kutta(bathe_tableau("bathe:" + to_text(rho_inf), rho_inf));
}

bool StepScheme::is_explicit() const { return tableau && tableau->diagonal() == 0.0; }

int StepScheme::order() const {
  if (tableau) return tableau->order;
  return std::abs(gamma - (0.5 - alpha_m + alpha_f)) < 1e-12 ? 2 : 1;
}

const std::vector<std::string>& step_scheme_names() {
  static const std::vector<std::string> names{"average_acceleration",
                                              "linear_acceleration",
                                              "central_difference",
                                              "newmark",
                                              "hht",
                                              "generalized_alpha",
                                              "bathe",
                                              "tr_bdf2",
                                              "sdirk4",
                                              "rk4",
                                              "dormand_prince"};
  return names;
}

StepScheme step_scheme(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const std::vector<double> p =
      colon == std::string::npos ? std::vector<double>{} : numbers(text, text.substr(colon + 1));
  const auto expect = [&](std::size_t low, std::size_t high) {
    if (p.size() < low || p.size() > high)
      throw ModelError({{"method", "parameters", text, "",
                         name + " takes " +
                             (high == 0     ? std::string("no numbers")
                              : low == high ? std::to_string(low) + " numbers"
                                            : "one number or none")}});
  };
  if (name == "average_acceleration") return expect(0, 0), average_acceleration();
  if (name == "linear_acceleration") {
    expect(0, 0);
    return {name, 0.0, 0.0, 1.0 / 6.0, 0.5};
  }
  if (name == "central_difference") {
    expect(0, 0);
    return {name, 0.0, 0.0, 0.0, 0.5};
  }
  if (name == "newmark") return expect(2, 2), newmark(p[0], p[1]);
  if (name == "hht") return expect(0, 1), p.empty() ? hht() : hht(p[0]);
  if (name == "generalized_alpha")
    return expect(0, 1), p.empty() ? generalized_alpha() : generalized_alpha(p[0]);
  if (name == "bathe") return expect(0, 1), p.empty() ? bathe() : bathe(p[0]);
  if (name == "tr_bdf2") return expect(0, 0), runge_kutta(bathe_tableau(name, 0.0));
  if (name == "sdirk4") return expect(0, 0), runge_kutta(sdirk4_tableau());
  if (name == "rk4") return expect(0, 0), runge_kutta(rk4_tableau());
  if (name == "dormand_prince") return expect(0, 0), runge_kutta(dormand_prince_tableau());
  throw ModelError({{"method", "name", name, "",
                     "is no method" + did_you_mean(name, step_scheme_names()) +
                         "; there are average_acceleration, linear_acceleration, "
                         "central_difference, newmark:BETA,GAMMA, hht:ALPHA, "
                         "generalized_alpha:RHO_INF, bathe:RHO_INF, tr_bdf2, sdirk4, rk4 and "
                         "dormand_prince"}});
}

}  // namespace drev
