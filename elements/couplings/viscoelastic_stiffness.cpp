#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/couplings/viscoelastic_stiffness.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kFastest = 8.0;  // c_j/m_j over the highest frequency of the fit
constexpr int kPoints = 80;       // frequencies of the fit
constexpr int kSweeps = 20000;    // sweeps of the coordinate descent at most
constexpr int kMostBranches = 12;
constexpr double kLeastStatic =
    0.1;  // k_0 over the stated static stiffness, so that it carries a mean torque [-]

double table_value(const std::vector<double>& at, const std::vector<double>& values, double x) {
  if (x <= at.front()) return values.front();
  if (x >= at.back()) return values.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin());
  return values[i - 1] + (values[i] - values[i - 1]) * (x - at[i - 1]) / (at[i] - at[i - 1]);
}

/// Least squares |A x - 1|, x >= 0, x_0 >= least, from A'A and A'1: coordinate descent, which cannot leave these.
std::vector<double> non_negative_fit(const std::vector<std::vector<double>>& normal,
                                     const std::vector<double>& right, double least) {
  const std::size_t n = right.size();
  std::vector<double> x(n, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0.0, size = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      double residual = right[i];
      for (std::size_t j = 0; j < n; ++j) residual -= normal[i][j] * x[j];
      const double next = std::max(i == 0 ? least : 0.0, x[i] + residual / normal[i][i]);
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
  const auto any = [](const std::vector<double>& etas) {
    return std::any_of(etas.begin(), etas.end(), [](double eta) { return eta > 0.0; });
  };
  const Params& p = params_;
  return p.loss_factor > 0.0 || p.frequencies.size() > 1 || any(p.loss_factors) ||
         any(p.by_mean_torque.loss_factors) || any(p.by_amplitude.loss_factors);
}

bool ViscoelasticStiffness::usable() const {
  std::vector<Finding> findings;
  ParameterCheck quiet("", findings);
  check(quiet);
  return findings.empty();
}

std::complex<double> ViscoelasticStiffness::at(double omega, const CarriedLoad& load) const {
  const Params& p = params_;
  double k = p.stiffness, eta = p.loss_factor;
  bool given = !std::isnan(k);
  const auto take = [&](const std::vector<double>& x, const std::vector<double>& stiffnesses,
                        const std::vector<double>& etas, double here) {
    if (x.empty()) return;
    const double k_here = table_value(x, stiffnesses, here), eta_here = table_value(x, etas, here);
    k = given ? k * k_here / stiffnesses.front() : k_here;
    // Without loss at its first point a table has none to scale.
    eta = !given ? eta_here : etas.front() > 0.0 ? eta * eta_here / etas.front() : eta;
    given = true;
  };
  take(p.frequencies, p.stiffnesses, p.loss_factors, omega / kTwoPi);
  const auto take_table = [&](const Table& t, double here) {
    take(t.at, t.stiffnesses, t.loss_factors, here);
  };
  take_table(p.by_mean_torque, std::abs(load.mean_torque));
  take_table(p.by_amplitude, load.amplitude);
  return {k, k * eta};
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
    static_stiffness_ = held_stiffness_ = at(1.0).real();
    return;
  }
  const double low = kTwoPi * p.lowest_frequency, high = kTwoPi * p.highest_frequency;
  const int wanted =
      p.branches > 0 ? p.branches
                     : std::min(kMostBranches, 1 + static_cast<int>(std::ceil(2.0 * std::log10(high / low))));
  const double first = 0.5 / high, last = 2.0 / low;
  std::vector<Branch> unit;  // branches for a stiffness of 1
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
  const std::vector<double> found = non_negative_fit(normal, right, kLeastStatic * at(0.0).real());
  static_stiffness_ = found[0];
  for (std::size_t j = 0; j < unit.size(); ++j)
    if (found[j + 1] > 1e-9 * found[0])
      branches_.push_back({found[j + 1], found[j + 1] * unit[j].damping, found[j + 1] * unit[j].inertia});
  held_stiffness_ = static_stiffness_;
  for (const Branch& b : branches_) held_stiffness_ += b.stiffness;
  each_frequency([&](double omega) {
    fit_error_ = std::max(fit_error_, std::abs(chain(omega) - at(omega)) / std::abs(at(omega)));
  });
}

void ViscoelasticStiffness::check(ParameterCheck& check) const {
  const Params& p = params_;
  const auto check_table = [&](const std::string& name, const std::vector<double>& at, const char* unit,
                               const std::vector<double>& stiffnesses, const std::vector<double>& etas) {
    if (at.empty() && stiffnesses.empty() && etas.empty()) return;
    if (at.empty() || stiffnesses.size() != at.size() || etas.size() != at.size())
      check.fail(name, std::to_string(at.size()) + " points", "",
                 "must have as many stiffnesses and loss factors as points, at least 1");
    check.increasing(name, at, unit);
    if (!at.empty()) check.non_negative(name, at.front(), unit);
    for (const double k : stiffnesses) check.positive(name + ".stiffness", k, "N m/rad");
    for (const double eta : etas) check.within(name + ".loss_factor", eta, 0.0, 2.0, "");
  };
  check_table("by_frequency", p.frequencies, "Hz", p.stiffnesses, p.loss_factors);
  bool given = !p.frequencies.empty() || !std::isnan(p.stiffness);
  const auto check_load = [&](const char* name, const Table& t, const char* unit) {
    check_table(name, t.at, unit, t.stiffnesses, t.loss_factors);
    const bool lossy =
        std::any_of(t.loss_factors.begin(), t.loss_factors.end(), [](double x) { return x > 0.0; });
    if (given && lossy && !(t.loss_factors.front() > 0.0))
      check.fail(std::string(name) + ".loss_factor", "0", "",
                 "must be > 0 at the first point of a table that scales others");
    given = given || !t.at.empty();
  };
  check_load("by_mean_torque", p.by_mean_torque, "N m");
  check_load("by_amplitude", p.by_amplitude, "rad");
  check.non_negative("at_mean_torque", p.at_mean_torque, "N m");
  check.non_negative("at_amplitude", p.at_amplitude, "rad");
  if (!given || !std::isnan(p.stiffness)) check.positive("stiffness", p.stiffness, "N m/rad");
  check.within("loss_factor", p.loss_factor, 0.0, 2.0, "");
  if (!p.frequencies.empty() && (!std::isnan(p.stiffness) || p.loss_factor != 0.0))
    check.fail("stiffness", to_text(p.stiffness), "N m/rad",
               "must not be given together with a table over the frequency");
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
  if (loses() || follows_mean_torque() || !amplitudes().empty())
    terms.frequency_stiffnesses.push_back({b, this});
  terms.outputs.push_back({.suffix = "", .stiffness = torque, .damping = damping * b, .deflection = b});
}

}  // namespace drev
