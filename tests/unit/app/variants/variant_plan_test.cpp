// Which parameters variant i has: grids, orders, samples with their marginals and correlations; Sobol indices.
#include "app/variants/variant_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "app/variants/quasi_random.hpp"
#include "app/variants/sobol_indices.hpp"
#include "tests/catch.hpp"

using namespace drev;
using namespace drev::app;

namespace {

VariantPlan plan_of(const std::vector<std::string>& words, const std::string& sample,
                    const std::vector<std::string>& correlate = {}) {
  std::vector<Finding> findings;
  std::vector<Varied> varied = read_varied(words, sample.empty() ? 1e12 : 0.0, findings);
  std::optional<Sampling> sampling;
  if (!sample.empty()) sampling = read_sampling(sample, findings);
  VariantPlan plan(std::move(varied), sampling, read_correlations(correlate, findings), findings);
  for (const Finding& finding : findings) UNSCOPED_INFO(finding.text());
  CHECK(findings.empty());
  return plan;
}

/// What is wrong with the words, in one text.
std::string faults_of(const std::vector<std::string>& words, const std::string& sample,
                      const std::vector<std::string>& correlate = {}) {
  std::vector<Finding> findings;
  std::vector<Varied> varied = read_varied(words, sample.empty() ? 1e12 : 0.0, findings);
  std::optional<Sampling> sampling;
  if (!sample.empty()) sampling = read_sampling(sample, findings);
  std::vector<Correlation> correlations = read_correlations(correlate, findings);
  if (findings.empty())
    const VariantPlan plan(std::move(varied), sampling, std::move(correlations), findings);
  std::string text;
  for (const Finding& finding : findings) text += finding.text() + "\n";
  return text;
}

std::vector<double> values_of_column(const VariantPlan& plan, std::size_t parameter) {
  std::vector<double> values;
  for (std::uint64_t i = 0; i < plan.count(); ++i)
    values.push_back(std::stod(plan.parameters(i)[parameter].second));
  return values;
}

double average(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

double covariance(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = average(x), my = average(y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mx) * (y[i] - my);
  return sum / static_cast<double>(x.size());
}

}  // namespace

TEST_CASE("Combinations of values: the last parameter varies fastest") {
  const VariantPlan plan = plan_of({"a=1,2", "b=0:0.5:1", "c=x"}, "");
  REQUIRE(plan.count() == 6);
  CHECK(plan.parameters(0) == ParameterValues{{"a", "1"}, {"b", "0"}, {"c", "x"}});
  CHECK(plan.parameters(1) == ParameterValues{{"a", "1"}, {"b", "0.5"}, {"c", "x"}});
  CHECK(plan.parameters(5) == ParameterValues{{"a", "2"}, {"b", "1"}, {"c", "x"}});
}

TEST_CASE("Orders of 9 cylinders: all 40,320 that begin with cylinder 1, each once") {
  const VariantPlan plan = plan_of({"firing_order=orders(9)"}, "");
  REQUIRE(plan.count() == 40320);
  std::set<std::string> orders;
  std::string last;
  for (std::uint64_t i = 0; i < plan.count(); ++i) {
    const std::string order = plan.parameters(i)[0].second;
    CHECK(order > last);
    orders.insert(last = order);
  }
  CHECK(orders.size() == 40320);
  CHECK(*orders.begin() == "1-2-3-4-5-6-7-8-9");
  CHECK(*orders.rbegin() == "1-9-8-7-6-5-4-3-2");
}

TEST_CASE("A Latin hypercube has one value in each of N equal parts of every parameter, whatever N") {
  for (const int n : {1, 2, 7, 100, 1000}) {
    const VariantPlan plan =
        plan_of({"a=uniform(0,1)", "b=uniform(-2,2)"}, "lhs:" + std::to_string(n) + ":3");
    std::vector<double> a = values_of_column(plan, 0), b = values_of_column(plan, 1);
    std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
    for (int i = 0; i < n; ++i) {
      CHECK(std::floor(a[static_cast<std::size_t>(i)] * n) == i);
      CHECK(std::floor((b[static_cast<std::size_t>(i)] + 2.0) / 4.0 * n) == i);
    }
  }
}

TEST_CASE("Samples have the mean, deviation and correlations asked for, another seed is another sample") {
  const std::string kind = GENERATE("random", "lhs", "sobol");
  const VariantPlan plan =
      plan_of({"a=normal(10,2)", "b=normal(0,1)", "c=uniform(0,1)"}, kind + ":4096", {"a,b=0.8", "b,c=-0.5"});
  const std::vector<double> a = values_of_column(plan, 0), b = values_of_column(plan, 1),
                            c = values_of_column(plan, 2);
  // Four standard errors of independent samples.
  CHECK(average(a) == Approx(10.0).margin(4.0 * 2.0 / 64.0));
  CHECK(std::sqrt(covariance(a, a)) == Approx(2.0).epsilon(4.0 / std::sqrt(2.0 * 4096.0)));
  CHECK(average(c) == Approx(0.5).margin(4.0 / std::sqrt(12.0) / 64.0));
  CHECK(covariance(c, c) == Approx(1.0 / 12.0).epsilon(0.06));
  CHECK(covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b)) == Approx(0.8).margin(0.03));
  // Of a uniform value behind a Gaussian copula with rho: sqrt(3/pi) rho.
  CHECK(covariance(b, c) / std::sqrt(covariance(b, b) * covariance(c, c)) ==
        Approx(-0.5 * std::sqrt(3.0 / std::numbers::pi)).margin(0.05));
  const VariantPlan other = plan_of({"a=normal(10,2)"}, kind + ":4096:2");
  CHECK(values_of_column(other, 0) != a);
  // A Sobol sequence of another seed has the same digits, some of them turned over.
  if (kind != "sobol") CHECK(std::abs(covariance(values_of_column(other, 0), a)) < 0.3);
}

TEST_CASE("The Sobol sequence integrates more sharply than random numbers do, and is found by its number") {
  const VariantPlan plan = plan_of({"a=uniform(0,1)", "b=uniform(0,1)", "c=uniform(0,1)"}, "sobol:4096");
  const std::vector<double> a = values_of_column(plan, 0), b = values_of_column(plan, 1),
                            c = values_of_column(plan, 2);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (0.5 + a[i]) * (0.5 + b[i]) * (0.5 + c[i]) / 4096.0;  // the integral over the cube is 1
  CHECK(std::abs(sum - 1.0) < 5e-4);                             // random numbers: 0.008
  CHECK(plan.parameters(4000) == plan.parameters(4000));
}

TEST_CASE("The quantile of the normal distribution, at published values") {
  CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-14));
  CHECK(normal_quantile(0.5) == Approx(0.0).margin(1e-16));
  CHECK(normal_quantile(0.001) == Approx(-3.090232306167813).epsilon(1e-14));
  CHECK(normal_part(1.959963984540054) == Approx(0.975).epsilon(1e-14));
  CHECK(normal_part(-40.0) > 0.0);
  CHECK(normal_part(40.0) < 1.0);
}

TEST_CASE("Sobol indices of the Ishigami function, beside their closed form") {
  // f = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, x uniform on -pi..pi. Ishigami and Homma, ISUMA 1990.
  const VariantPlan plan = plan_of(
      {"x1=uniform(-3.14159265358979,3.14159265358979)", "x2=uniform(-3.14159265358979,3.14159265358979)",
       "x3=uniform(-3.14159265358979,3.14159265358979)"},
      "saltelli:4096");
  REQUIRE(plan.count() == 4096 * 5);
  SobolIndices sobol(3, 4096);
  for (std::uint64_t block = 0; block < 4096; ++block) {
    std::vector<double> f;
    for (std::uint64_t k = 0; k < 5; ++k) {
      const ParameterValues x = plan.parameters(5 * block + k);
      const double x1 = std::stod(x[0].second), x2 = std::stod(x[1].second), x3 = std::stod(x[2].second);
      f.push_back(std::sin(x1) + 7.0 * std::pow(std::sin(x2), 2) + 0.1 * std::pow(x3, 4) * std::sin(x1));
    }
    sobol.add(block, f);
  }
  const std::vector<SobolIndex> found = sobol.indices();
  REQUIRE(found.size() == 3);
  const double pi = std::numbers::pi, a = 7.0, b = 0.1;
  const double v1 = 0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2), v2 = a * a / 8.0,
               v13 = b * b * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0), v = v1 + v2 + v13;
  const double first[] = {v1 / v, v2 / v, 0.0}, total[] = {(v1 + v13) / v, v2 / v, v13 / v};
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK(found[j].first == Approx(first[j]).margin(0.01));
    CHECK(found[j].total == Approx(total[j]).margin(0.01));
    CHECK(std::abs(found[j].first - first[j]) < 4.0 * found[j].first_error + 1e-3);
    CHECK(found[j].first_error < 0.03);
  }
}

TEST_CASE("What is wrong with a sample is named") {
  using Catch::Contains;
  CHECK_THAT(faults_of({"a=uniform(0,1)"}, ""), Contains("a=uniform(0,1)") && Contains("needs --sample"));
  CHECK_THAT(faults_of({"a=uniform(2,1)"}, "lhs:10"), Contains("uniform(LOW,HIGH)"));
  CHECK_THAT(faults_of({"a=normal(1,0)"}, "lhs:10"), Contains("normal(MEAN,DEVIATION)"));
  CHECK_THAT(faults_of({"a=orders(1)"}, ""), Contains("orders(N)") && Contains("2 to 20"));
  CHECK_THAT(faults_of({"a=1,2"}, "lhs"), Contains("random:N, lhs:N, sobol:N or saltelli:N"));
  CHECK_THAT(faults_of({"a=1,2"}, "lhs:1.5"), Contains("whole number"));
  CHECK_THAT(faults_of({"a=1,2", "b=3,4"}, "lhs:10", {"a,b=1"}), Contains("above -1 and below 1"));
  CHECK_THAT(faults_of({"a=1,2"}, "lhs:10", {"a,b=0.5"}), Contains("b is not varied"));
  CHECK_THAT(faults_of({"a=1,2", "b=1,2", "c=1,2"}, "lhs:10", {"a,b=0.9", "b,c=0.9", "a,c=-0.9"}),
             Contains("not positive definite"));
  CHECK_THAT(faults_of({"a=1,2", "b=1,2"}, "saltelli:10", {"a,b=0.5"}), Contains("independent parameters"));
}
