// The 95 % intervals of a study's means and quantiles: how often they hold what is known, and where there are none.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using Json = nlohmann::json;

namespace {

/// A disc on a spring, let go at the product of six parameters, which is its largest angle.
std::string product_model(const drev::test::TemporaryFolder& folder) {
  const std::string path = (folder / "product.toml").string();
  std::ofstream(path) << "format = 1\n[parameters]\na = 1\nb = 1\nc = 1\nd = 1\ne = 1\nf = 1\n[nodes]\n"
                         "n = { initial_angle_rad = \"a*b*c*d*e*f\" }\n[elements]\n"
                         "J = { type = \"inertia\", node = \"n\", inertia_kg_m2 = 1 }\n"
                         "s = { type = \"ground_spring\", node = \"n\", stiffness_Nm_per_rad = 1 }\n";
  return path;
}

drev::test::Outcome study(const std::string& path, const std::string& out, const std::string& sample,
                          bool json = true) {
  std::vector<std::string> words{"run",         path,       "--out",  out,      "--record",
                                 "n.angle_rad", "--sample", sample,   "--step", "1e-3",
                                 "--duration",  "2e-3",     "--table"};
  for (const char* name : {"a", "b", "c", "d", "e", "f"})
    words.insert(words.end(), {"--vary", std::string(name) + "=uniform(0.5,1.5)"});
  if (json) words.push_back("--json");
  return drev_command(words);
}

Json figure(const Json& summary) {
  for (const Json& f : summary.at("figures"))
    if (f.at("name") == "n.angle_rad.max") return f;
  return {};
}

}  // namespace

TEST_CASE("Intervals of a saltelli sample hold the true mean and median as often as they say", "[once]") {
  const drev::test::TemporaryFolder folder;
  const std::string path = product_model(folder);
  // The mean is 1; the median is by 2e7 random numbers, to 2e-4.
  constexpr double kMedian = 0.7782;
  int means = 0, medians = 0;
  constexpr int kStudies = 60;
  for (int seed = 1; seed <= kStudies; ++seed) {
    const auto run =
        study(path, (folder / std::to_string(seed)).string(), "saltelli:16:" + std::to_string(seed));
    REQUIRE(run.exit_code == 0);
    const Json f = figure(Json::parse(run.out));
    CHECK(f.at("count") == 16 * 8);
    means += std::abs(f.at("mean").get<double>() - 1.0) <= f.at("mean_error").get<double>();
    const Json& median = f.at("quantiles")[2];
    // 32 values reach beyond the 95 % quantile four times out of five.
    CHECK(f.at("quantiles")[1].at("low").is_null());
    CHECK(f.at("quantiles")[3].at("low").is_number());
    CHECK(f.at("quantiles")[3].at("high").is_null());
    medians += median.at("low") <= kMedian && kMedian <= median.at("high");
  }
  CHECK(means >= 0.9 * kStudies);
  CHECK(medians >= 0.9 * kStudies);
}

TEST_CASE("One point of a sample tells no interval") {
  const drev::test::TemporaryFolder folder;
  const std::string path = product_model(folder);
  for (const std::string sample : {"random:1", "saltelli:1"}) {
    const auto run = study(path, (folder / sample).string(), sample);
    INFO(sample << run.err);
    REQUIRE(run.exit_code == 0);
    const Json f = figure(Json::parse(run.out));
    CHECK(f.at("mean").is_number());
    CHECK(f.at("mean_error").is_null());
    REQUIRE(f.at("quantiles").size() == 5);
    for (const Json& q : f.at("quantiles")) {
      CHECK(q.at("value").is_number());
      CHECK(q.at("low").is_null());
      CHECK(q.at("high").is_null());
    }
    CHECK_FALSE(contains(study(path, (folder / (sample + "t")).string(), sample, false).out, "+-"));
  }
  const auto two = study(path, (folder / "two").string(), "random:2");
  const Json f = figure(Json::parse(two.out));
  // s/sqrt(2) times the 97.5 % quantile of Student's t with 1 degree of freedom.
  CHECK(f.at("mean_error").get<double>() ==
        Approx(12.706 * f.at("deviation").get<double>() / std::sqrt(2.0)).epsilon(1e-4));
}
