#include "app/cli/method_option.hpp"

#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <optional>

#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"

namespace drev::app {

namespace {

/// "ALPHA 0 to 0.333, default 0.05; ", as the form of the method writes it.
std::string numbers_text(const MethodRow& row) {
  std::string text;
  for (const MethodParameter& number : row.parameters) {
    text +=
        number.form() + " " + short_digits(number.range.low, 4) + " to " + short_digits(number.range.high, 4);
    if (number.standard) text += ", default " + short_digits(*number.standard, 3);
    text += "; ";
  }
  return text;
}

}  // namespace

std::string methods_help() {
  std::string text =
      "Methods (default: exact, where nothing in the model forbids it and it is affordable, else\n"
      "dormand_prince, or sdirk4 where the model is too stiff for that, to 1e-4; the run says why; where a\n"
      "step is asked for average_acceleration). exact takes --tolerance; all others constant steps, --step,\n"
      "or with --tolerance steps controlled by it that end at contact changes; --step is then the largest.\n";
  constexpr std::size_t kForms = 30;
  for (const MethodRow& row : methods())
    text += "  " + pad_right(row.form(), kForms - 2) + wrap(numbers_text(row) + row.help, kForms);
  return text;
}

void check_step_scheme(const char* option, const std::string& text, std::vector<Finding>& findings) {
  try {
    step_scheme(text);
  } catch (const ModelError& error) {
    for (Finding finding : error.findings()) {
      if (finding.value == kExact) {
        finding.value = text;
        finding.range =
            std::string(kExact) + " takes no number behind it; its tolerance is given by --tolerance";
      } else if (finding.parameter == "name")
        finding.range = is_no_method(finding.value, methods());
      finding.place = kCommandLine;
      finding.parameter = option + (" " + finding.parameter);
      findings.push_back(std::move(finding));
    }
  }
}

void check_exact(const char* option, const System& system, std::vector<Finding>& findings) {
  if (const std::optional<std::string> why = why_not_exact(system))
    findings.push_back({kCommandLine, option, kExact, "", "cannot be used: " + *why});
}

}  // namespace drev::app
