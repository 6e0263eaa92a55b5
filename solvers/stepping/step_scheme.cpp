#include <drev/core/error.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "solvers/stepping/butcher_tableau.hpp"

namespace drev {

namespace {

using Numbers = std::vector<double>;

/// Throws ModelError with every number that is out of its range.
void check(const char* method, const std::vector<MethodParameter>& parameters, const Numbers& numbers) {
  std::vector<Finding> findings;
  ParameterCheck check(method, findings);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    check.within(parameters[i].name, numbers[i], parameters[i].range.low, parameters[i].range.high, "");
  if (!findings.empty()) throw ModelError(findings);
}

/// Numbers separated by commas; none where the text is anything else.
std::optional<Numbers> read_numbers(const std::string& text) {
  Numbers numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  while (true) {
    double value = 0.0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec != std::errc{} || (result.ptr != end && *result.ptr != ',')) return {};
    numbers.push_back(value);
    if (result.ptr == end) return numbers;
    at = result.ptr + 1;
  }
}

/// The numbers after the name, those left out with their standard values; none where they do not fit.
std::optional<Numbers> numbers_of(const MethodRow& row, const std::string& text) {
  const std::size_t colon = text.find(':');
  std::optional<Numbers> numbers = Numbers{};
  if (colon != text.npos) numbers = read_numbers(text.substr(colon + 1));
  if (!numbers || numbers->size() > row.parameters.size()) return {};
  for (std::size_t i = numbers->size(); i < row.parameters.size(); ++i) {
    if (!row.parameters[i].standard) return {};
    numbers->push_back(*row.parameters[i].standard);
  }
  return numbers;
}

}  // namespace

StepScheme newmark(double beta, double gamma) {
  check("newmark", {kNewmarkBeta, kNewmarkGamma}, {beta, gamma});
  return {"newmark:" + to_text(beta) + "," + to_text(gamma), 0.0, 0.0, beta, gamma};
}

StepScheme average_acceleration() { return {"average_acceleration", 0.0, 0.0, 0.25, 0.5}; }

StepScheme hht(double alpha) {
  check("hht", {kHhtAlpha}, {alpha});
  return {"hht:" + to_text(alpha), 0.0, alpha, 0.25 * (1 + alpha) * (1 + alpha), 0.5 + alpha};
}

StepScheme generalized_alpha(double rho_inf) {
  check("generalized_alpha", {kGeneralizedAlphaRho}, {rho_inf});
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
  check("bathe", {kBatheRho}, {rho_inf});
  return runge_kutta(bathe_tableau("bathe:" + to_text(rho_inf), rho_inf));
}

bool StepScheme::is_explicit() const { return tableau && tableau->diagonal() == 0.0; }

int StepScheme::order() const {
  if (tableau) return tableau->order;
  return std::abs(gamma - (0.5 - alpha_m + alpha_f)) < 1e-12 ? 2 : 1;
}

const std::vector<MethodRow>& step_schemes() {
  static const std::vector<MethodRow> rows{
      {"average_acceleration",
       {},
       "implicit, second order; keeps the energy of linear systems",
       [](const Numbers&) { return average_acceleration(); }},
      {"hht",
       {kHhtAlpha},
       "implicit, second order; damps the fastest modes",
       [](const Numbers& p) { return hht(p[0]); }},
      {"generalized_alpha",
       {kGeneralizedAlphaRho},
       "implicit, second order; damps the fastest modes, 1: none, 0: in one step",
       [](const Numbers& p) { return generalized_alpha(p[0]); }},
      {"newmark",
       {kNewmarkBeta, kNewmarkGamma},
       "implicit, second order, first with GAMMA above 0.5",
       [](const Numbers& p) { return newmark(p[0], p[1]); }},
      {"bathe",
       {kBatheRho},
       "implicit, two stages, second order; 1: no damping, 0: in one step",
       [](const Numbers& p) { return bathe(p[0]); }},
      {"tr_bdf2",
       {},
       "bathe:0 by its other name",
       [](const Numbers&) { return runge_kutta(bathe_tableau("tr_bdf2", 0.0)); }},
      {"sdirk4",
       {},
       "implicit, five stages, fourth order; damps the fastest modes",
       [](const Numbers&) { return runge_kutta(sdirk4_tableau()); }},
      {"linear_acceleration",
       {},
       "implicit, second order; for small steps only: a larger constant step is refused",
       [](const Numbers&) {
         return StepScheme{"linear_acceleration", 0.0, 0.0, 1.0 / 6.0, 0.5};
       }},
      {"central_difference",
       {},
       "second order; for small steps only, the same",
       [](const Numbers&) {
         return StepScheme{"central_difference", 0.0, 0.0, 0.0, 0.5};
       }},
      {"rk4",
       {},
       "explicit, fourth order; for small steps only, the same",
       [](const Numbers&) { return runge_kutta(rk4_tableau()); }},
      {"dormand_prince", {}, "explicit, fifth order; for small steps only, the same", [](const Numbers&) {
         return runge_kutta(dormand_prince_tableau());
       }}};
  return rows;
}

std::string MethodParameter::form() const {
  std::string text = name;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string MethodRow::form() const {
  std::string text = name;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string number = (i == 0 ? ":" : ",") + parameters[i].form();
    text += parameters[i].standard ? "[" + number + "]" : number;
  }
  return text;
}

std::vector<std::string> names_of(const std::vector<MethodRow>& rows) {
  std::vector<std::string> names;
  for (const MethodRow& row : rows) names.push_back(row.name);
  return names;
}

std::string must_be_one_of(const std::vector<MethodRow>& rows) {
  std::string text = "must be ";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += (i == 0 ? "" : i + 1 < rows.size() ? ", " : " or ") + rows[i].form();
  return text;
}

std::string is_no_method(const std::string& name, const std::vector<MethodRow>& rows) {
  return "is no method" + did_you_mean(name, names_of(rows)) + "; " + must_be_one_of(rows);
}

StepScheme step_scheme(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  const std::vector<MethodRow>& rows = step_schemes();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const MethodRow& r) { return r.name == name; });
  if (row == rows.end()) throw ModelError({{"method", "name", name, "", is_no_method(name, rows)}});
  const std::optional<Numbers> numbers = numbers_of(*row, text);
  if (!numbers) throw ModelError({{"method", "numbers", text, "", "must be " + row->form()}});
  return row->scheme(*numbers);
}

}  // namespace drev
