#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "solvers/periodic/linear_response.hpp"
#include "solvers/periodic/sweep_peaks.hpp"
#include "solvers/periodic/trigonometric_sum.hpp"
#include "solvers/run/for_all.hpp"

namespace drev {

namespace {

constexpr double kMostNumbers = 1e8;  // largest sections x speeds x orders: 3.2 GB with twists
constexpr double kLeftOut = 1e-3;     // share of a load left out of the orders above which it is reported [-]
constexpr double kHalf = 0.5;
constexpr int kHalfOrders = 24;

void check_options(const System& system, const LinearSweepOptions& options, std::vector<Finding>& findings) {
  ParameterCheck check(system.name() + "/sweep", findings);
  const auto rising = [&](const char* name, const std::vector<double>& values, const char* unit) {
    check.increasing(name, values, unit);
    if (!values.empty()) check.positive(name, values.front(), unit);
  };
  rising("speeds", options.speeds, "rad/s");
  rising("orders", options.orders, "");
  if (options.speeds.empty()) check.fail("speeds", "none", "", "must be at least one");
}

/// Allocates the results of a section at every speed.
SweepSection to_section(const LinearResponse::Section& given, Eigen::Index orders, Eigen::Index speeds) {
  SweepSection section;
  section.name = given.name;
  section.unit = given.unit;
  section.contact = given.contact;
  section.amplitude.resize(orders, speeds);
  if (!given.twist.empty()) {
    section.twist_unit = given.twist_unit;
    section.twist.resize(orders, speeds);
  }
  for (Vector* values :
       {&section.mean, &section.maximum, &section.minimum, &section.maximum_angle, &section.minimum_angle,
        &section.twist_mean, &section.twist_half_range, &section.heat})
    values->setZero(speeds);
  return section;
}

/// Extremes of the sums of torques and of twists. Sections whose torque is their twist times one factor need no separate
/// sum for the twist.
class SectionExtremes {
 public:
  explicit SectionExtremes(const std::vector<LinearResponse::Section>& sections) {
    for (std::size_t c = 0; c < sections.size(); ++c) {
      const LinearResponse::Section& s = sections[c];
      const bool damped =
          std::any_of(s.damping.begin(), s.damping.end(), [](const Entry& e) { return e.coeff != 0.0; });
      const bool proportional = !damped && s.twist.size() == s.stiffness.size() && !s.twist.empty();
      factor_.push_back(proportional ? std::abs(s.twist.front().coeff / s.stiffness.front().coeff) : 0.0);
      if (!proportional && !s.twist.empty()) summed_.push_back(c);
    }
  }
  void find(const LinearResponse::Point& point, TrigonometricSum& sum) {
    sums_.clear();
    for (Eigen::Index c = 0; c < point.amplitude.cols(); ++c) sums_.push_back(point.amplitude.col(c).data());
    for (const std::size_t c : summed_) sums_.push_back(point.twist.col(static_cast<Eigen::Index>(c)).data());
    sum.extremes(sums_, found_);
    twist_half_range_.assign(factor_.size(), 0.0);
    for (std::size_t c = 0; c < factor_.size(); ++c)
      twist_half_range_[c] = factor_[c] * found_[c].half_range();
    for (std::size_t i = 0; i < summed_.size(); ++i)
      twist_half_range_[summed_[i]] = found_[factor_.size() + i].half_range();
  }
  const SumExtremes& of(std::size_t section) const { return found_[section]; }
  double twist_half_range(std::size_t section) const { return twist_half_range_[section]; }

 private:
  std::vector<double> factor_;       // half range of the twist over that of the section; 0: summed separately
  std::vector<std::size_t> summed_;  // sections with a separate sum for the twist
  std::vector<const std::complex<double>*> sums_;
  std::vector<SumExtremes> found_;
  std::vector<double> twist_half_range_;
};

void put(const LinearResponse::Point& point, const SectionExtremes& extremes, Eigen::Index at,
         LinearSweep& sweep) {
  const auto orders = static_cast<std::ptrdiff_t>(sweep.orders.size());
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    SweepSection& section = sweep.sections[c];
    const auto column = static_cast<Eigen::Index>(c);
    std::copy_n(point.amplitude.col(column).data(), orders, section.amplitude.col(at).data());
    section.mean[at] = point.mean[column];
    const SumExtremes& found = extremes.of(c);
    section.maximum[at] = found.max;
    section.minimum[at] = found.min;
    section.maximum_angle[at] = found.max_angle;
    section.minimum_angle[at] = found.min_angle;
    section.heat[at] = point.heat[column];
    if (section.twist.size() == 0) continue;
    std::copy_n(point.twist.col(column).data(), orders, section.twist.col(at).data());
    section.twist_mean[at] = point.twist_mean[column];
    section.twist_half_range[at] = extremes.twist_half_range(c);
  }
}

/// Data that each thread has separately.
struct Worker {
  Worker(const TrigonometricSum& sums, const std::vector<LinearResponse::Section>& sections)
      : sum(sums), extremes(sections) {}
  TrigonometricSum sum;
  SectionExtremes extremes;
  LinearResponse::Point point;
};

/// Number of threads. Each thread has to build the equations again, which takes as long as some frequencies do.
std::size_t threads_for(const System& system, const LinearSweepOptions& options, std::size_t orders) {
  // Least unknowns times frequencies for a thread: about 0.7 ms, or 20 frequencies of a large model.
  constexpr double kWorth = 1.5e4, kWorthFrequencies = 20.0;
  const double work = static_cast<double>(options.speeds.size() * orders) * system.size();
  const auto most = static_cast<std::size_t>(work / (kWorth + kWorthFrequencies * system.size())) + 1;
  return thread_count(std::min(most, options.speeds.size()), options.threads);
}

void note_left_out(const System& system, const std::vector<OrderContent::Content>& found,
                   const OrderContent& content, LinearSweep& sweep) {
  for (std::size_t l = 0; l < content.loads().size(); ++l) {
    const OrderContent::Content& c = found[l];
    if (!(c.left_out > 0.0)) continue;
    const LoadTerm& load = *content.loads()[l];
    const std::string name = system.element_instances()[idx(index(load.element))].name;
    const LinearSweep::LeftOut left{load.suffix.empty() ? name : name + "_" + load.suffix,
                                    c.left_out / c.rms};
    if (left.share > kLeftOut) sweep.left_out.push_back(left);
    if (left.share > sweep.most_left_out.share) sweep.most_left_out = left;
  }
}

void take(SweepLargest& largest, double value, double speed) {
  if (value > largest.value || (std::isnan(largest.value) && !std::isnan(value))) largest = {value, speed};
}

/// Of the values at the speeds and of one value of the section's peaks.
SweepLargest largest_of(const LinearSweep& sweep, int section, const Vector& values,
                        double SweepPeak::*at_peak) {
  SweepLargest largest;
  for (std::size_t i = 0; i < sweep.speeds.size() && static_cast<Eigen::Index>(i) < values.size(); ++i)
    take(largest, values[static_cast<Eigen::Index>(i)], sweep.speeds[i]);
  for (const SweepPeak& peak : sweep.peaks)
    if (peak.section == section) take(largest, peak.*at_peak, peak.speed);
  return largest;
}

const SweepSection& section_of(const LinearSweep& sweep, int section) {
  return sweep.sections[static_cast<std::size_t>(section)];
}

}  // namespace

std::complex<double> SweepModes::at(Eigen::Index mode, double speed) const {
  Eigen::Index i = 0;
  while (i + 2 < speeds.size() && speeds[i + 1] < speed) ++i;
  if (speeds.size() < 2) return lambda(mode, 0);
  const double part = (speed - speeds[i]) / (speeds[i + 1] - speeds[i]);
  if (lambda(mode, i) == 0.0 || lambda(mode, i + 1) == 0.0)
    return part == 0.0 ? lambda(mode, i) : part == 1.0 ? lambda(mode, i + 1) : 0.0;
  return (1.0 - part) * lambda(mode, i) + part * lambda(mode, i + 1);
}

LinearSweep sweep_linear(const System& system, const LinearSweepOptions& options) {
  refuse_controllers(system, "a sweep of speeds");
  LinearSweep sweep;
  sweep.speeds = options.speeds;
  sweep.orders = options.orders;
  if (sweep.orders.empty())
    for (int i = 1; i <= kHalfOrders; ++i) sweep.orders.push_back(kHalf * i);
  std::vector<Finding> findings;
  check_options(system, options, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  LinearResponse response(system, options, sweep.orders, findings);
  const double numbers = static_cast<double>(response.sections().size()) *
                         static_cast<double>(sweep.speeds.size() * sweep.orders.size());
  if (numbers > kMostNumbers)
    findings.push_back({system.name() + "/sweep", "", to_text(numbers), "",
                        "numbers are too many (sections times speeds times orders, at most " +
                            to_text(kMostNumbers) + "); name the sections that are wanted"});
  if (!findings.empty()) throw ModelError(std::move(findings));
  TrigonometricSum sum(sweep.orders, system.name() + "/sweep", options.needs_cycle);
  sweep.cycle = sum.cycle();
  sweep.floating_parts = response.floating();

  const auto speeds = static_cast<Eigen::Index>(sweep.speeds.size());
  for (const LinearResponse::Section& section : response.sections())
    sweep.sections.push_back(to_section(section, static_cast<Eigen::Index>(sweep.orders.size()), speeds));
  sweep.unbalanced.assign(sweep.floating_parts.size(), Vector::Zero(speeds));
  sweep.several_amplitudes.assign(sweep.speeds.size(), 0);
  sweep.input_power.setZero(speeds);
  sweep.dissipated_power.setZero(speeds);
  std::vector<Vector> load_sums(sweep.unbalanced.size(), Vector::Zero(speeds));
  std::vector<std::unique_ptr<Worker>> workers(threads_for(system, options, sweep.orders.size()));
  std::atomic<bool> ended{false};
  for_all(workers.size(), static_cast<int>(workers.size()), [&](std::size_t w, std::size_t thread) {
    workers[w] = std::make_unique<Worker>(sum, response.sections());
    Worker& worker = *workers[w];
    std::optional<LinearResponse> own;
    std::vector<Finding> none;
    if (w > 0) own.emplace(system, options, sweep.orders, none);
    LinearResponse& here = own ? *own : response;
    const auto count = static_cast<Eigen::Index>(workers.size()), number = static_cast<Eigen::Index>(w);
    for (Eigen::Index i = speeds * number / count; i < speeds * (number + 1) / count; ++i) {
      if (ended) return;
      if (thread == 0 && options.pause) try {
          options.pause();
        } catch (...) {
          ended = true;
          throw;
        }
      const double speed = sweep.speeds[static_cast<std::size_t>(i)];
      here.vibration(speed, worker.point);
      sweep.several_amplitudes[static_cast<std::size_t>(i)] = here.several_amplitudes();
      here.mean(speed, worker.point);
      worker.extremes.find(worker.point, worker.sum);
      put(worker.point, worker.extremes, i, sweep);
      sweep.input_power[i] = worker.point.input_power;
      sweep.dissipated_power[i] = worker.point.dissipated_power;
      for (std::size_t f = 0; f < sweep.unbalanced.size(); ++f) {
        sweep.unbalanced[f][i] = worker.point.unbalanced[static_cast<Eigen::Index>(f)];
        load_sums[f][i] = worker.point.load_sum[static_cast<Eigen::Index>(f)];
      }
    }
  });
  for (std::size_t f = 0; f < sweep.unbalanced.size(); ++f)
    sweep.unbalanced_scale.push_back(load_sums[f].maxCoeff());
  note_left_out(system, response.content().at(reference_direction(system) * sweep.speeds.back()),
                response.content(), sweep);
  if (options.refine) find_sweep_peaks(system, response, sum, options.pause, sweep);
  return sweep;
}

SweepLargest largest_half_range(const LinearSweep& sweep, int section) {
  return largest_of(sweep, section, section_of(sweep, section).half_range(), &SweepPeak::half_range);
}

SweepLargest largest_twist(const LinearSweep& sweep, int section) {
  return largest_of(sweep, section, section_of(sweep, section).twist_half_range,
                    &SweepPeak::twist_half_range);
}

SweepLargest largest_heat(const LinearSweep& sweep, int section) {
  const SweepSection& s = section_of(sweep, section);
  SweepLargest largest = largest_of(sweep, section, s.heat, &SweepPeak::heat);
  for (const SweepPoint& point : sweep.points) take(largest, point.heat[section], point.speed);
  take(largest, s.heat_peak, s.heat_peak_speed);
  return largest;
}

Vector load_damping(const System& system, double speed) {
  std::vector<Finding> findings;
  OrderContent content(system, {}, findings);
  ParameterCheck(system.name() + "/load damping", findings).positive("speed", speed, "rad/s");
  if (!findings.empty()) throw ModelError(std::move(findings));
  Vector damping = Vector::Zero(system.damping_values().size());
  content.add_slopes(reference_direction(system) * speed, &damping, nullptr);
  return damping;
}

}  // namespace drev
