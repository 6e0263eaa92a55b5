#include <drev/core/units.hpp>
#include <drev/elements/couplings/viscoelastic_stiffness.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kFastest = 8.0;  // c_j/m_j over the highest frequency of the fit
constexpr int kPoints = 80;       // of the fit
constexpr int kSweeps = 20000;    // of the coordinate descent, at most
constexpr int kMostBranches = 12;

double table_value(const std::vector<double>& at, const std::vector<double>& values, double x) {
  if (x <= at.front()) return values.front();
  if (x >= at.back()) return values.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin());
  return values[i - 1] + (values[i] - values[i - 1]) * (x - at[i - 1]) / (at[i] - at[i - 1]);
}

/// Least squares |A x - 1|, x >= 0, from A'A and A'1: coordinate descent, which cannot leave x >= 0.
std::vector<double> non_negative_fit(const std::vector<std::vector<double>>& normal,
                                     const std::vector<double>& right) {
  const std::size_t n = right.size();
  std::vector<double> x(n, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0.0, size = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      double residual = right[i];
      for (std::size_t j = 0; j < n; ++j) residual -= normal[i][j] * x[j];
      const double next = std::max(0.0, x[i] + residual / normal[i][i]);
      moved = std::max(moved, std::abs(next - x[i]));
      size = std::max(size, next);
      x[i] = next;
    }
    if (moved <= 1e-12 * size) break;
  }
  return x;
}

}  // namespace

ViscoelasticStiffness::ViscoelasticStiffness(Params params) : params_(std::move(params)) {
  if (usable()) fit();
}

bool ViscoelasticStiffness::loses() const {
  return params_.loss_factor > 0.0 || params_.frequencies.size() > 1 ||
         (!params_.loss_factors.empty() && params_.loss_factors.front() > 0.0);
}

bool ViscoelasticStiffness::usable() const {
  std::vector<Finding> findings;
  ParameterCheck quiet("", findings);
  check(quiet);
  return findings.empty();
}

std::complex<double> ViscoelasticStiffness::at(double omega) const {
  const Params& p = params_;
  if (p.frequencies.empty()) return {p.stiffness, p.stiffness * p.loss_factor};
  const double f = omega / kTwoPi, k = table_value(p.frequencies, p.stiffnesses, f);
  return {k, k * table_value(p.frequencies, p.loss_factors, f)};
}

namespace {

std::complex<double> branch_at(const ViscoelasticStiffness::Branch& b, double omega) {
  const std::complex<double> inner(-b.inertia * omega * omega, b.damping * omega);
  return b.stiffness * inner / (b.stiffness + inner);
}

}  // namespace

std::complex<double> ViscoelasticStiffness::chain(double omega) const {
  std::complex<double> sum = static_stiffness_;
  for (const Branch& b : branches_) sum += branch_at(b, omega);
  return sum;
}

void ViscoelasticStiffness::fit() {
  const Params& p = params_;
  if (!loses()) {
    static_stiffness_ = at(1.0).real();
    return;
  }
  const double low = kTwoPi * p.lowest_frequency, high = kTwoPi * p.highest_frequency;
  const int wanted =
      p.branches > 0 ? p.branches
                     : std::min(kMostBranches, 1 + static_cast<int>(std::ceil(2.0 * std::log10(high / low))));
  const double first = 0.5 / high, last = 2.0 / low;
  std::vector<Branch> unit;  // of stiffness 1
  for (int j = 0; j < wanted; ++j) {
    const double place = wanted > 1 ? static_cast<double>(j) / (wanted - 1) : 0.5;
    const double tau = first * std::pow(last / first, place);
    unit.push_back({1.0, tau, tau / (kFastest * high)});
  }
  const std::size_t n = unit.size() + 1;
  std::vector<std::vector<double>> normal(n, std::vector<double>(n, 0.0));
  std::vector<double> right(n, 0.0);
  const auto each_frequency = [&](const auto& use) {
    for (int i = 0; i < kPoints; ++i) use(low * std::pow(high / low, static_cast<double>(i) / (kPoints - 1)));
  };
  each_frequency([&](double omega) {
    const std::complex<double> target = at(omega);
    std::vector<std::complex<double>> row{1.0 / target};
    for (const Branch& b : unit) row.push_back(branch_at(b, omega) / target);
    for (std::size_t i = 0; i < n; ++i) {
      right[i] += row[i].real();
      for (std::size_t j = 0; j < n; ++j) normal[i][j] += (std::conj(row[i]) * row[j]).real();
    }
  });
  const std::vector<double> found = non_negative_fit(normal, right);
  static_stiffness_ = found[0];
  for (std::size_t j = 0; j < unit.size(); ++j)
    if (found[j + 1] > 1e-9 * found[0])
      branches_.push_back({found[j + 1], found[j + 1] * unit[j].damping, found[j + 1] * unit[j].inertia});
  each_frequency([&](double omega) {
    fit_error_ = std::max(fit_error_, std::abs(chain(omega) - at(omega)) / std::abs(at(omega)));
  });
}

void ViscoelasticStiffness::check(ParameterCheck& check) const {
  const Params& p = params_;
  const std::size_t before = p.frequencies.size();
  if (before == 0) {
    check.positive("stiffness", p.stiffness, "N m/rad");
    check.within("loss_factor", p.loss_factor, 0.0, 2.0, "");
  } else {
    if (p.stiffnesses.size() != before || p.loss_factors.size() != before)
      check.fail("table", std::to_string(before) + " frequencies", "",
                 "must have as many stiffnesses and loss factors as frequencies");
    check.increasing("table.frequency", p.frequencies, "Hz");
    for (const double k : p.stiffnesses) check.positive("table.stiffness", k, "N m/rad");
    for (const double eta : p.loss_factors) check.within("table.loss_factor", eta, 0.0, 2.0, "");
    if (!std::isnan(p.stiffness) || p.loss_factor != 0.0)
      check.fail("stiffness", to_text(p.stiffness), "N m/rad",
                 "must not be there beside a table over the frequency");
  }
  if (p.branches < 0 || p.branches > kMostBranches)
    check.fail("branches", std::to_string(p.branches), "", "must be 1 to 12, or 0 for two a decade");
  check.positive("permitted_error", p.permitted_error, "");
  if (!loses()) return;
  check.positive("lowest_frequency", p.lowest_frequency, "Hz");
  check.positive("highest_frequency", p.highest_frequency, "Hz");
  if (!(p.highest_frequency > p.lowest_frequency))
    check.fail("highest_frequency", to_text(p.highest_frequency), "Hz",
               "must exceed lowest_frequency, " + to_text(p.lowest_frequency) +
                   ": the band over which runs in time fit the loss factor");
  if (fit_error_ > p.permitted_error)
    check.fail("permitted_error", to_text(p.permitted_error), "",
               "but the chain that stands for the loss factor in time is off by " + to_text(fit_error_) +
                   " in the band; make the band narrower, or permit it");
}

void ViscoelasticStiffness::describe(const LocalRow& b, int first, double damping, Terms& terms) const {
  LocalRow torque = static_stiffness_ * b;
  terms.stiffness += static_stiffness_ * b * b.transpose();
  terms.damping += damping * b * b.transpose();
  for (std::size_t j = 0; j < branches_.size(); ++j) {
    const auto inner = static_cast<Eigen::Index>(first) + static_cast<Eigen::Index>(j);
    LocalRow row = b, alone = LocalRow::Zero(b.size());
    row[inner] = -1.0;
    alone[inner] = 1.0;
    terms.stiffness += branches_[j].stiffness * row * row.transpose();
    terms.damping(inner, inner) += branches_[j].damping;
    terms.mass(inner, inner) += branches_[j].inertia;
    terms.speed_ratio_constraints.push_back({.b = alone});
    torque += branches_[j].stiffness * row;
  }
  if (loses()) terms.frequency_stiffnesses.push_back({b, this});
  terms.outputs.push_back({.suffix = "", .stiffness = torque, .damping = damping * b, .deflection = b});
}

}  // namespace drev
