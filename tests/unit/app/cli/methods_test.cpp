// A row of methods() is all that a method in time needs: parser, messages, --help and completion are made of
// it. Every row is tried with each of them.
#include <drev/core/error.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;
using drev::test::drev_command;

namespace {

std::string written(const MethodRow& row, const std::vector<double>& numbers) {
  std::string text = row.name;
  for (std::size_t i = 0; i < numbers.size(); ++i) text += (i == 0 ? ":" : ",") + to_text(numbers[i]);
  return text;
}

std::vector<double> lowest(const MethodRow& row) {
  std::vector<double> numbers;
  for (const MethodParameter& number : row.parameters) numbers.push_back(number.range.low);
  return numbers;
}

std::string refusal(const std::string& text) {
  try {
    step_scheme(text);
    return {};
  } catch (const ModelError& error) {
    return error.what();
  }
}

/// Text with every run of blanks and line ends as one blank.
std::string in_one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line, word;
  while (words >> word) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::vector<std::string> offered(const std::string& option, const std::string& word) {
  const auto run = drev_command({"__complete", "run", "camshaft", option, word});
  std::vector<std::string> names;
  std::istringstream in(run.out);
  for (std::string name; std::getline(in, name);) names.push_back(name);
  return names;
}

}  // namespace

TEST_CASE("Every method is known by its row alone") {
  const std::string run_help = in_one_line(drev_command({"run", "--help"}).out);
  const std::string chart_help = in_one_line(drev_command({"chart", "--help"}).out);
  const auto refused = drev_command({"run", "two_inertia", "--method", "qqqq"});
  CHECK(refused.exit_code == 2);
  for (const MethodRow& row : methods()) {
    INFO(row.name);
    for (const std::string& help : {run_help, chart_help}) {
      CHECK(contains(help, " " + row.form() + " "));
      CHECK(contains(help, in_one_line(row.help)));
    }
    CHECK(contains(refused.err, " " + row.form()));
    const std::string name = row.name;
    const auto names = offered("--method", name.substr(0, name.size() - 1));
    CHECK(std::count(names.begin(), names.end(), name) == 1);
    // One letter too many leads back to it.
    const auto typed = drev_command({"run", "two_inertia", "--method", name + "q"});
    CHECK(typed.exit_code == 2);
    CHECK(contains(typed.err, "did you mean '" + name + "'?"));
  }
}

TEST_CASE("Every step scheme is read as its row writes it, and refused outside its ranges") {
  REQUIRE(step_schemes().size() + 1 == methods().size());
  for (const MethodRow& row : step_schemes()) {
    INFO(row.form());
    REQUIRE(row.scheme != nullptr);
    CHECK(step_scheme(written(row, lowest(row))).name == row.scheme(lowest(row)).name);
    const std::string one_more = written(row, lowest(row)) + (row.parameters.empty() ? ":1" : ",1");
    for (const std::string& wrong : {one_more, std::string(row.name) + ":x", std::string(row.name) + ":"})
      CHECK(contains(refusal(wrong), wrong + ", must be " + row.form()));
    const bool all_have_standards = std::all_of(row.parameters.begin(), row.parameters.end(),
                                                [](const auto& p) { return p.standard.has_value(); });
    CHECK(refusal(row.name).empty() == all_have_standards);
    for (std::size_t i = 0; i < row.parameters.size(); ++i) {
      const MethodParameter& number = row.parameters[i];
      std::vector<double> numbers = lowest(row);
      for (const double wrong : {number.range.low - 0.01, number.range.high + 0.01}) {
        numbers[i] = wrong;
        const std::string said = refusal(written(row, numbers));
        CHECK(contains(said, std::string(number.name) + " = " + to_text(wrong)));
        CHECK(contains(said, to_text(number.range.low)));
        CHECK(contains(said, to_text(number.range.high)));
      }
      if (number.standard) CHECK(number.range.holds(*number.standard));
    }
  }
}
