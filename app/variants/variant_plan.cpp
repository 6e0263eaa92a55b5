#include "app/variants/variant_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"
#include "app/variants/quasi_random.hpp"
#include "core/dense/factorization.hpp"

namespace drev::app {

namespace {

using Kind = Sampling::Kind;

constexpr std::pair<const char*, Kind> kSamplings[] = {
    {"random", Kind::random}, {"lhs", Kind::lhs}, {"sobol", Kind::sobol}, {"saltelli", Kind::saltelli}};

/// A pseudo-random permutation of 0 ... count - 1: four Feistel rounds on the smallest even number of bits,
/// repeated until the value is below count.
std::uint64_t shuffled(std::uint64_t i, std::uint64_t count, std::uint64_t key) {
  const auto half = std::max<unsigned>(1, (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2);
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = i >> half, right = i & mask;
    for (std::uint64_t round = 0; round < 4; ++round) {
      const std::uint64_t next = left ^ (hashed(right, hashed(round, key)) & mask);
      left = right;
      right = next;
    }
    i = left << half | right;
  } while (i >= count);
  return i;
}

}  // namespace

std::string sampling_text(const Sampling& sampling) {
  for (const auto& [name, kind] : kSamplings)
    if (kind == sampling.kind)
      return std::string(name) + ":" + std::to_string(sampling.points) + ":" + std::to_string(sampling.seed);
  return {};
}

std::optional<Sampling> read_sampling(const std::string& text, std::vector<Finding>& findings) {
  const std::vector<std::string> parts = split(text, ':');
  Sampling sampling;
  double points = 0.0, seed = 1.0;
  const auto* kind = std::find_if(std::begin(kSamplings), std::end(kSamplings),
                                  [&](const auto& row) { return row.first == parts[0]; });
  const auto whole = [](double x, double most) { return x == std::floor(x) && x >= 1.0 && x <= most; };
  if (kind == std::end(kSamplings) || parts.size() < 2 || parts.size() > 3 ||
      !read_number(parts[1], points) || !whole(points, 1e12) ||
      (parts.size() == 3 && (!read_number(parts[2], seed) || !whole(seed, 1e9)))) {
    findings.push_back(
        {kCommandLine, "--sample", text, "",
         "must be random:N, lhs:N, sobol:N or saltelli:N with a whole number N from 1 to 1e12, "
         "and may have a seed behind it, from 1 to 1e9: lhs:1000:7"});
    return {};
  }
  return Sampling{kind->second, static_cast<std::uint64_t>(points), static_cast<std::uint64_t>(seed)};
}

std::vector<Correlation> read_correlations(const std::vector<std::string>& words,
                                           std::vector<Finding>& findings) {
  std::vector<Correlation> all;
  for (const std::string& word : words) {
    const std::size_t comma = word.find(','), equals = word.rfind('=');
    Correlation c;
    if (comma == word.npos || equals == word.npos || comma > equals || comma == 0 || comma + 1 == equals ||
        !read_number(word.substr(equals + 1), c.value) || !(std::abs(c.value) < 1.0)) {
      findings.push_back({kCommandLine, "--correlate", word, "",
                          "must be NAME,NAME=C with a correlation C above -1 and below 1"});
      continue;
    }
    c.one = word.substr(0, comma);
    c.other = word.substr(comma + 1, equals - comma - 1);
    all.push_back(std::move(c));
  }
  return all;
}

VariantPlan::VariantPlan(std::vector<Varied> varied, std::optional<Sampling> sampling,
                         std::vector<Correlation> correlations, std::vector<Finding>& findings)
    : varied_(std::move(varied)), sampling_(sampling), correlations_(std::move(correlations)) {
  count_ = 1;
  if (sampling_) {
    count_ = sampling_->points;
    if (sampling_->kind == Kind::saltelli) count_ *= varied_.size() + 2;
    const std::size_t dimensions = varied_.size() * (sampling_->kind == Kind::saltelli ? 2 : 1);
    if (varied_.empty())
      findings.push_back(
          {kCommandLine, "--sample", sampling_text(*sampling_), "", "needs --vary: what is sampled"});
    if (dimensions > kMostDimensions)
      findings.push_back(
          {kCommandLine, "--sample", sampling_text(*sampling_), "",
           "takes at most " + std::to_string(kMostDimensions) + " parameters (saltelli: half)"});
    if (static_cast<double>(count_) > kMost)
      findings.push_back({kCommandLine, "--sample", sampling_text(*sampling_), "",
                          "makes more than " + short_digits(kMost, 7) + " variants"});
  } else {
    for (const Varied& v : varied_) {
      count_ *= std::max<std::uint64_t>(1, v.count());
      if (v.count() == 0)
        findings.push_back({kCommandLine, "--vary", v.name + "=" + v.text, "",
                            "is a distribution and needs --sample, such as --sample lhs:1000"});
    }
    if (!correlations_.empty()) findings.push_back({kCommandLine, "--correlate", "", "", "needs --sample"});
  }
  if (sampling_ && !correlations_.empty()) read_correlations(findings);
}

void VariantPlan::read_correlations(std::vector<Finding>& findings) {
  const auto size = static_cast<Eigen::Index>(varied_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
  for (const Correlation& c : correlations_) {
    const auto place = [&](const std::string& name) {
      return std::find_if(varied_.begin(), varied_.end(), [&](const Varied& v) { return v.name == name; }) -
             varied_.begin();
    };
    const std::ptrdiff_t i = place(c.one), j = place(c.other);
    const std::string word = c.one + "," + c.other;
    if (i == size || j == size)
      findings.push_back(
          {kCommandLine, "--correlate", word, "", (i == size ? c.one : c.other) + " is not varied"});
    else if (i == j || matrix(i, j) != 0.0)
      findings.push_back({kCommandLine, "--correlate", word, "", "must name two parameters, once"});
    else
      matrix(i, j) = matrix(j, i) = c.value;
  }
  if (sampling_->kind == Kind::saltelli)
    findings.push_back({kCommandLine, "--correlate", "", "",
                        "cannot be with --sample saltelli: Sobol indices are of independent parameters"});
  const CholeskyFactor cholesky(matrix);
  if (!cholesky.positive_definite())
    findings.push_back({kCommandLine, "--correlate", "", "",
                        "are correlations that cannot be together: their matrix is not positive definite"});
  else
    factor_ = cholesky.lower();
}

double VariantPlan::coordinate(std::uint64_t i, std::size_t dimension) const {
  const std::uint64_t key = hashed(dimension + 1, hashed(sampling_->seed, 0));
  const double random = to_unit(hashed(i, key));
  if (sampling_->kind == Kind::random) return random;
  return (static_cast<double>(shuffled(i, count_, key)) + random) / static_cast<double>(count_);
}

std::vector<double> VariantPlan::unit_point(std::uint64_t i) const {
  const std::size_t size = varied_.size();
  std::vector<double> u(size);
  if (sampling_->kind == Kind::saltelli) {
    const std::vector<double> both = sobol_point(i / (size + 2), 2 * size, sampling_->seed);
    const std::uint64_t part = i % (size + 2);  // 0: A, 1: B, 2 + j: A with parameter j of B
    for (std::size_t d = 0; d < size; ++d) u[d] = both[part == 1 || part == d + 2 ? size + d : d];
    return u;
  }
  if (sampling_->kind == Kind::sobol)
    u = sobol_point(i, size, sampling_->seed);
  else
    for (std::size_t d = 0; d < size; ++d) u[d] = coordinate(i, d);
  if (factor_.size() == 0) return u;
  Eigen::VectorXd z(static_cast<Eigen::Index>(size));
  for (std::size_t d = 0; d < size; ++d) z[static_cast<Eigen::Index>(d)] = normal_quantile(u[d]);
  z = factor_ * z;
  for (std::size_t d = 0; d < size; ++d) u[d] = normal_part(z[static_cast<Eigen::Index>(d)]);
  return u;
}

ParameterValues VariantPlan::parameters(std::uint64_t i) const {
  ParameterValues values;
  if (!sampling_) {
    for (auto v = varied_.rbegin(); v != varied_.rend(); ++v) {
      values.emplace_back(v->name, v->value(i % v->count()));
      i /= v->count();
    }
    std::reverse(values.begin(), values.end());
    return values;
  }
  const std::vector<double> u = unit_point(i);
  for (std::size_t d = 0; d < varied_.size(); ++d) {
    const Varied& v = varied_[d];
    std::string text;
    if (const std::uint64_t count = v.count())
      text = v.value(std::min(count - 1, static_cast<std::uint64_t>(u[d] * static_cast<double>(count))));
    else
      text = v.kind == Varied::Kind::uniform ? v.between(u[d])
                                             : short_digits(v.first + v.second * normal_quantile(u[d]), 12);
    values.emplace_back(v.name, std::move(text));
  }
  return values;
}

}  // namespace drev::app
