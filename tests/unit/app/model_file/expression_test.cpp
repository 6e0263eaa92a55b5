// Expressions: values by hand, units that go with them, faults.
#include "app/model_file/expression.hpp"

#include <drev/app/model_file/units.hpp>
#include <drev/core/units.hpp>

#include "tests/catch.hpp"

using namespace drev::app;

namespace {

const Scope kScope{{{"n", 9.0},
                    {"i", 3.0},
                    {"gap_mm", 0.15},
                    {"play_mm", 0.05},
                    {"gap_m", 1.0},
                    {"f_Hz", 40.0},
                    {"one_deg", 1.0},
                    {"x_2", 7.0}},
                   {{"order", {1, 4, 8, 2, 6, 9, 3, 5, 7}}, {"J_kg_m2", {0.5, 0.25}}},
                   {{"drive", "gears"}}};

std::string refused(const std::string& text) {
  try {
    evaluate(text, kScope);
  } catch (const ExpressionError& error) {
    return error.sentence;
  }
  return "accepted";
}

}  // namespace

TEST_CASE("Expressions have the values that they have in C++") {
  const auto value = [](const char* text) { return evaluate(text, kScope).value; };
  CHECK(value("1 + 2*3") == 7.0);
  CHECK(value("(1 + 2)*3") == 9.0);
  CHECK(value("2 - 3 - 4") == -5.0);
  CHECK(value("8/4/2") == 1.0);
  CHECK(value("-2*-3") == 6.0);
  CHECK(value("--1e-3") == 1e-3);
  CHECK(value(" 1.5e3 ") == 1500.0);
  CHECK(value("n - i") == 6.0);
  CHECK(value("x_{i-1} + 1") == 8.0);
  CHECK(value("order[i]") == 8.0);
  CHECK(value("position(order, i)") == 7.0);
  CHECK(value("-2*pi*(position(order, i) - 1)/n") == -drev::kTwoPi * 6.0 / 9);
}

TEST_CASE("Units go with the values") {
  const auto unit = [](const char* text) { return evaluate(text, kScope).unit; };
  CHECK(unit("gap_mm").compare("mm") == 0);
  CHECK(unit("2*gap_mm/3 + play_mm + 1").compare("mm") == 0);
  CHECK(unit("gap_mm/play_mm").empty());
  CHECK(unit("n*i").empty());
  CHECK(unit("J_kg_m2[2]").compare("kg_m2") == 0);
  // Products and quotients are known by their powers of kg, m, s and by their size.
  CHECK(evaluate("gap_mm*f_Hz", kScope).fits("mm_per_s"));
  CHECK_FALSE(evaluate("gap_mm*f_Hz", kScope).fits("m_per_s"));
  CHECK(evaluate("1/f_Hz", kScope).fits("s"));
  CHECK_FALSE(evaluate("1/f_Hz", kScope).fits("ms"));
  CHECK(evaluate("J_kg_m2[1]*f_Hz^2", kScope).fits("Nm"));
  CHECK(evaluate("sqrt(gap_mm^2 + play_mm^2)", kScope).fits("mm"));
  CHECK_FALSE(evaluate("gap_mm^2", kScope).fits("mm"));
  CHECK(evaluate("si(gap_mm)*f_Hz", kScope).fits("m_per_s"));
  CHECK(evaluate("gap_mm*f_Hz", kScope).how_to_fit("m_per_s").find("si(...)") != std::string::npos);
  CHECK(evaluate("si(gap_mm)", kScope).how_to_fit("Nm") == "; plain(...) gives the number without a unit");
  CHECK(evaluate("si(gap_mm)", kScope).value == Approx(0.15e-3).epsilon(1e-14));
  CHECK(evaluate("plain(gap_mm)", kScope).plain());
  CHECK(evaluate("gap_mm*f_Hz/(play_mm*f_Hz)", kScope).plain());
  CHECK(unit_suffix("stiffness_Nm_per_rad") == "Nm_per_rad");
  CHECK(unit_suffix("speed_rad_per_s") == "rad_per_s");
  CHECK(unit_suffix("cylinders").empty());
  CHECK(unit_suffix("_mm").empty());
}

TEST_CASE("Powers, roots and functions") {
  const auto value = [](const char* text) { return evaluate(text, kScope).value; };
  CHECK(value("2^3") == 8.0);
  CHECK(value("2^3^2") == 512.0);
  CHECK(value("-2^2") == -4.0);
  CHECK(value("2*3^2") == 18.0);
  CHECK(value("4^-0.5") == 0.5);
  CHECK(value("sqrt(n)") == 3.0);
  CHECK(value("sin(pi/6)") == Approx(0.5).epsilon(1e-15));
  CHECK(value("sin(30*one_deg)") == Approx(0.5).epsilon(1e-15));
  CHECK(value("cos(0) + tan(0) + exp(0) + log(exp(2)) + abs(-3)") == Approx(7.0).epsilon(1e-15));
  CHECK(value("4*atan(1) + tanh(log(3))") == Approx(3.14159265358979323846 + 0.8).epsilon(1e-15));
  CHECK(value("max(1, n, i) - min(gap_mm, play_mm)") == Approx(8.95).epsilon(1e-15));
}

TEST_CASE("Conditions compare numbers and texts") {
  for (const char* right :
       {"n == 9", "n != i", "i < n and n > i", "drive == 'gears'", "'held' != drive", "not drive == 'held'",
        "(n < 1 or i == 3) and gap_mm <= 0.15", "(n + 1) == 10", "n >= 9 or i == 1 and drive == 'held'"})
    CHECK(holds(right, kScope));
  for (const char* wrong : {"n == 8", "drive == 'held'", "n < 1 or i > 3", "not n == 9"})
    CHECK_FALSE(holds(wrong, kScope));
  const auto said = [](const char* text) {
    try {
      holds(text, kScope);
    } catch (const ExpressionError& error) {
      return error.sentence;
    }
    return std::string("accepted");
  };
  CHECK(said("n").find("is no condition") != std::string::npos);
  CHECK(said("drive == 3").find("compares a text with a number") != std::string::npos);
  CHECK(said("drive < 'x'").find("compares texts by <") != std::string::npos);
  CHECK(said("drive == 'x").find("lacks a '") != std::string::npos);
  CHECK(said("gap_mm == gap_m").find("compares mm and m") != std::string::npos);
  CHECK(said("n == 9 n").find("cannot stand") != std::string::npos);
}

TEST_CASE("Faults of expressions are named") {
  const std::vector<std::pair<const char*, const char*>> faults{
      {"", "ends where a number or a name is expected"},
      {"1 +", "ends where"},
      {"1 1", "has '1' in column 3"},
      {"2 $ 3", "has '$' in column 3"},
      {"2\u00b7pi", "has '\u00b7' in column 2"},
      {"(1", "lacks a ')' at its end"},
      {"m", "names m, which is no parameter"},
      {"gap_nm", "did you mean 'gap_"},
      {"gap_mm + gap_m", "adds mm and m"},
      {"1/0", "gives no finite number"},
      {"order", "needs a place in the list order"},
      {"order[0]", "takes number 0 of order, which has 9"},
      {"order[10]", "takes number 10"},
      {"order[1.5]", "takes number 1.5"},
      {"ordre[1]", "did you mean 'order'?"},
      {"position(order, 10)", "seeks 10, which the list does not hold"},
      {"position(order)", "lacks a ','"},
      {"2*1e999", "has the number 1e999 in column 3, which is outside"},
      {".", "has '.' in column 1"},
      {"gap_mm*f_Hz + gap_mm", "adds mm*Hz and mm"},
      {"sqrt(-1)", "takes the root of -1"},
      {"sin(gap_mm)", "takes sin of mm"},
      {"2^gap_mm", "has an exponent in mm"},
      {"sinus(1)", "calls sinus(), which is no function"},
      {"drive + 1", "takes drive for a number"}};
  for (const auto& [text, said] : faults) {
    INFO(text << ": " << refused(text));
    CHECK(refused(text).find(said) != std::string::npos);
  }
  CHECK(refused(std::string(200, '(')).find("nested too deeply") != std::string::npos);
  CHECK(refused(std::string(78, ' ') + "1\u03c0").find("1\" has '\u03c0' in column 80") != std::string::npos);
  CHECK(refused(std::string(2000, '1')).find("longer than 1000") != std::string::npos);
  CHECK(evaluate(std::string(900, '-') + "1", kScope).value == 1.0);
}

TEST_CASE("Names are filled in") {
  CHECK(expand("fuel_{i}", kScope) == "fuel_3");
  CHECK(expand("{i-1}-{i + 1}", kScope) == "2-4");
  CHECK(expand("plain", kScope) == "plain");
  CHECK(expand("on_{drive}", kScope) == "on_gears");
  CHECK(expand("nested_{x_{1+1}}", kScope) == "nested_7");
  for (const char* text : {"fuel_{", "fuel_{i/2}", "fuel_{}", "fuel_{j}", "{1e12}"})
    CHECK_THROWS_AS(expand(text, kScope), ExpressionError);
}
