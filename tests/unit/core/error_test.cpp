// Texts of findings, parameter checks, and the nearest name.
#include <drev/core/error.hpp>

#include <cmath>
#include <cstdlib>

#include "tests/catch.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;

TEST_CASE("A finding names place, parameter, value, unit and range") {
  CHECK(Finding{"camshaft/mesh_1", "normal_backlash", "-0.0001", "m", "must be >= 0"}.text() ==
        "camshaft/mesh_1: normal_backlash = -0.0001 m, must be >= 0");
  CHECK(Finding{"camshaft", "ratio", "3", "", "must not be 3"}.text() ==
        "camshaft: ratio = 3, must not be 3");
  CHECK(Finding{"camshaft", "motion", "", "", "has no function"}.text() ==
        "camshaft: motion, has no function");
  CHECK(Finding{"camshaft", "", "", "", "is empty"}.text() == "camshaft: is empty");
}

TEST_CASE("What would steer a terminal is shown, not printed") {
  const std::string nul("a\0b", 3);
  CHECK(Finding{"m\x1b[2J", nul, "\r\n\t", "\x7f", "C1 \xc2\x9b[31m"}.text() ==
        "m\\x1b[2J: a\\x00b = \\x0d\\x0a\\x09 \\x7f, C1 \\xc2\\x9b[31m");
  const std::string harmless =
      "Z\xc3\xbcge \xc2\xa0 \xe2\x80\xa8 \xc2";  // an umlaut, blanks, and a cut letter
  CHECK(Finding{harmless, "", "", "", ""}.text() == harmless);
  CHECK_FALSE(has_control_characters(harmless));
  CHECK(has_control_characters(nul));
}

TEST_CASE("A ModelError lists its findings, one a line") {
  const ModelError error({{"a", "x", "1", "m", "low"}, {"b", "y", "2", "s", "high"}});
  CHECK(std::string(error.what()) == "a: x = 1 m, low\nb: y = 2 s, high");
  CHECK(error.findings().size() == 2);
}

TEST_CASE("Parameter checks refuse what is out of range, and what is not a number") {
  std::vector<Finding> found;
  ParameterCheck check("model/shaft", found);
  check.finite("p", 1e308, "m");
  check.positive("p", 5e-324, "m");
  check.non_negative("p", 0.0, "m");
  check.within("p", 1.0, 1.0, 2.0, "m");
  check.within("p", 2.0, 1.0, 2.0, "m");
  check.increasing("p", {}, "m");
  check.increasing("p", {-1.0, 0.0, 1e-300}, "m");
  check.all_finite("p", {0.0, -1e308}, "m");
  CHECK(found.empty());

  const auto refused = [&found](const std::string& text) {
    const bool as_expected = found.size() == 1 && found[0].text() == text;
    const std::string got = found.empty() ? "nothing" : found[0].text();
    found.clear();
    INFO(got);
    return as_expected;
  };
  check.finite("k", kInfinity, "N/m");
  CHECK(refused("model/shaft: k = infinity N/m, must be finite"));
  check.positive("k", 0.0, "N/m");
  CHECK(refused("model/shaft: k = 0 N/m, must be > 0 and finite"));
  check.positive("k", kNan, "N/m");
  CHECK(refused("model/shaft: k = NaN N/m, must be > 0 and finite"));
  check.non_negative("k", -1e-12, "N/m");
  CHECK(refused("model/shaft: k = -1e-12 N/m, must be >= 0 and finite"));
  check.non_negative("k", -kInfinity, "N/m");
  CHECK(refused("model/shaft: k = -infinity N/m, must be >= 0 and finite"));
  check.within("n", kNan, 1, 10, "");
  CHECK(refused("model/shaft: n = NaN, must be between 1 and 10"));
  check.increasing("x", {0.0, 1.0, 1.0}, "rad");
  CHECK(refused("model/shaft: x[2] = 1 rad, must be greater than the value before it, 1"));
  check.all_finite("x", {0.0, kNan}, "rad");
  CHECK(refused("model/shaft: x[1] = NaN rad, must be finite"));
}

TEST_CASE("Numbers are written so that they read back to the same double") {
  for (const double x : {0.1, 1.0 / 3.0, -1e-310, 1.7976931348623157e308, 0.15e-3, 750.0}) {
    CHECK(std::strtod(to_text(x).c_str(), nullptr) == x);
  }
  CHECK(to_text(0.1) == "0.1");
  CHECK(to_text(kNan) == "NaN");
  CHECK(to_text(kInfinity) == "infinity");
  CHECK(to_text(-kInfinity) == "-infinity");
}

TEST_CASE("The nearest name is near, or none") {
  const std::vector<std::string> names{"motor", "pinion", "cam_1", "cam_2", "crank_gear"};
  CHECK(nearest_name("moter", names) == "motor");
  CHECK(nearest_name("Pinion", names) == "pinion");
  CHECK(nearest_name("crankgear", names) == "crank_gear");
  CHECK(nearest_name("cam_1", names) == "cam_1");
  CHECK(nearest_name("motorr", names) == "motor");
  CHECK(nearest_name("windscreen_wiper", names).empty());
  CHECK(nearest_name("motor", {}).empty());
  CHECK(nearest_name("", {"ab"}).empty());
  // Two names of a megabyte, of which a comparison would take minutes.
  const std::string large(1'000'000, 'a');
  CHECK(nearest_name(large, {large + "b", "motor"}).empty());
  // As many edits as letters have nothing in common.
  CHECK(nearest_name("x", {"ab", "y"}).empty());
  CHECK(nearest_name("xy", {"ab"}).empty());
  CHECK(did_you_mean("moter", names) == "; did you mean 'motor'?");
  CHECK(did_you_mean("windscreen_wiper", names).empty());
}
