#include "solvers/periodic/sweep_peaks.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "solvers/periodic/bracketed_search.hpp"
#include "solvers/periodic/linear_response.hpp"
#include "solvers/periodic/trigonometric_sum.hpp"

namespace drev {

namespace {

constexpr double kUndamped = 1e-9;      // damping ratio that is rounding [-]
constexpr double kTooDamped = 0.7;      // damping ratio above which an order has no resonance [-]
constexpr std::size_t kMostPeaks = 10;  // largest number of peaks of a section
constexpr double kSmallPeak = 1e-3;     // smallest peak relative to the section's largest one [-]
constexpr double kSmallHeat = 0.1;      // smallest heat followed relative to the section's largest one [-]
constexpr double kSameSeed = 1e-2;      // part of a mode's half width below which two seeds are one [-]
constexpr double kPeakSpeed = 1e-7;     // tolerance of a peak's speed relative to it [-]
constexpr double kSameTop = 1e-6;       // relative difference of criticals' speeds that are one top [-]
constexpr double kSameSpeed = 1e-10;    // relative difference of speeds that are one but for rounding [-]
// Difference of lambda relative to it below which shapes are any of their common space [-].
constexpr double kCoincide = 1e-7;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(LinearResponse& response, TrigonometricSum& sum, const std::function<void()>& pause,
         LinearSweep& sweep, DampedPoles& poles)
      : response_(response),
        sum_(sum),
        pause_(pause),
        sweep_(sweep),
        poles_(poles),
        low_(sweep.speeds.front()),
        high_(sweep.speeds.back()) {
    find_content();
    const auto count = static_cast<Eigen::Index>(sweep.sections.size());
    largest_.assign(sweep.sections.size(), 0.0);
    for (std::size_t i = 0; i < sweep.speeds.size(); ++i) {
      SweepPoint point{sweep.speeds[i], Vector(count), Vector(count), Vector(count), Vector(count)};
      for (Eigen::Index c = 0; c < count; ++c) {
        const auto& s = sweep.sections[static_cast<std::size_t>(c)];
        const auto at = static_cast<Eigen::Index>(i);
        point.mean[c] = s.mean[at], point.maximum[c] = s.maximum[at], point.minimum[c] = s.minimum[at];
        point.heat[c] = s.heat[at];
      }
      note_largest(point);
      curves_.emplace(point.speed, std::move(point));
    }
  }

  void seed() {
    for (const double speed : poles_.jumps)
      if (speed > low_ && speed < high_ && !curves_.contains(speed)) curves_.emplace(speed, solved(speed));
    for (Eigen::Index m = 0; m < sweep_.modes.lambda.rows(); ++m)
      for (std::size_t k = 0; k < sweep_.orders.size(); ++k)
        if (has_content_[k])
          for (const double speed : meets(m, sweep_.orders[k])) seed(m, k, speed);
    for (const auto& [speed, point] : curves_)
      if (!std::binary_search(sweep_.speeds.begin(), sweep_.speeds.end(), speed) ||
          point.maximum.array().isInf().any())
        sweep_.points.push_back(point);
  }

  void find_peaks() {
    std::vector<double> speeds, values(curves_.size());
    for (const auto& [speed, at] : curves_) speeds.push_back(speed);
    for (std::size_t c = 0; c < sweep_.sections.size(); ++c) {
      std::vector<SweepPeak> peaks;
      std::transform(curves_.begin(), curves_.end(), values.begin(),
                     [c](const auto& at) { return at.second.half_range(static_cast<int>(c)); });
      for (const TopBracket& top : tops_of(speeds, values)) {
        const double here = values[top.point];
        if (!(here > kSmallPeak * largest_[c])) continue;
        SweepPeak peak;
        peak.section = static_cast<int>(c), peak.speed = speeds[top.point], peak.half_range = here;
        if (std::isfinite(here)) {
          const BracketedMaximum found = followed_top(top, peak.speed, here, kPeakSpeed * top.start,
                                                      [&](double speed) { return one(speed, c); });
          peak.speed = found.at, peak.half_range = found.value;
        }
        peak.at_end = top.at_end && peak.speed == speeds[top.point];
        peaks.push_back(peak);
      }
      std::stable_sort(peaks.begin(), peaks.end(),
                       [](const SweepPeak& a, const SweepPeak& b) { return a.half_range > b.half_range; });
      if (peaks.size() > kMostPeaks) peaks.resize(kMostPeaks);
      for (SweepPeak& peak : peaks) add_values(peak);
      sweep_.peaks.insert(sweep_.peaks.end(), peaks.begin(), peaks.end());
    }
  }

  /// Locates the largest heat of each section between the speeds: every local maximum of the speeds, the seeds and the peaks of
  /// the half range is followed.
  void find_heat() {
    for (std::size_t c = 0; c < sweep_.sections.size(); ++c) {
      std::map<double, double> heats;
      for (const auto& [speed, at] : curves_) heats[speed] = at.heat[static_cast<Eigen::Index>(c)];
      for (const SweepPeak& peak : sweep_.peaks)
        if (peak.section == static_cast<int>(c) && std::isfinite(peak.half_range))
          heats[peak.speed] = peak.heat;
      std::vector<double> speeds, values;
      double largest = 0.0;
      for (const auto& [speed, heat] : heats) {
        speeds.push_back(speed), values.push_back(heat);
        if (std::isfinite(heat)) largest = std::max(largest, heat);
      }
      const auto look = [&](double speed) {
        pause_();
        response_.vibration(speed, point_);
        return point_.heat[static_cast<Eigen::Index>(c)];
      };
      SweepSection& section = sweep_.sections[c];
      for (const TopBracket& top : tops_of(speeds, values)) {
        const double here = values[top.point];
        if (!(here > kSmallHeat * largest) || !std::isfinite(here)) continue;
        const BracketedMaximum best =
            followed_top(top, speeds[top.point], here, kPeakSpeed * top.start, look);
        if (top.at_end && best.at == speeds[top.point]) continue;  // nothing between the speeds
        if (!(section.heat_peak >= best.value))
          section.heat_peak = best.value, section.heat_peak_speed = best.at;
      }
    }
  }

  void find_criticals() {
    for (std::size_t i = 0; i < sweep_.criticals.size(); ++i) {
      SweepCritical& critical = sweep_.criticals[i];
      const int order = numbers_[i];
      if (critical.damping_ratio == 0.0) {
        find_undamped(critical, order);
        continue;
      }
      find_own_parts(critical, order);
      const auto section = static_cast<Eigen::Index>(critical.section);
      const auto amplitude = [&](double speed) {
        response_.vibration(speed, point_, order);
        return std::abs(point_.amplitude(order, section));
      };
      // Within half the mode's width. An order that only rises or falls there, on the flank of another mode, has no
      // top of this one: it is stated where it meets the mode.
      const double reach = 1.0 + std::abs(critical.damping_ratio), width = kPeakSpeed * critical.speed;
      const double from = std::max(low_, critical.speed / reach),
                   to = std::min(high_, critical.speed * reach);
      const BracketedMaximum found = bracketed_maximum(from, critical.speed, to, width, amplitude);
      const bool top = found.at > from + 2.0 * width && found.at < to - 2.0 * width;
      if (top) critical.speed = found.at;
      critical.amplitude = top ? found.value : amplitude(critical.speed);
      SweepCritical::InSection& own = critical.in_sections[static_cast<std::size_t>(critical.section)];
      own.speed = critical.speed, own.amplitude = critical.amplitude;
      critical.half_range = one(critical.speed, static_cast<std::size_t>(critical.section));
    }
    std::stable_sort(sweep_.criticals.begin(), sweep_.criticals.end(),
                     [](const SweepCritical& a, const SweepCritical& b) { return a.speed < b.speed; });
    // Where a load's kink makes a mode jump, the jump and a meeting beside it may have one top.
    const auto same = [](const SweepCritical& a, const SweepCritical& b) {
      return a.mode == b.mode && a.order == b.order && b.speed - a.speed <= kSameTop * b.speed;
    };
    sweep_.criticals.erase(std::unique(sweep_.criticals.begin(), sweep_.criticals.end(), same),
                           sweep_.criticals.end());
  }

 private:
  struct Meeting {
    double speed = 0.0;
    std::complex<double> lambda;
    double distance = kInfinite;  // of the order from the mode's frequency, as a part of half its width [-]
  };
  /// The speed near `speed`, which is of modes between the modes' speeds, at which an order is nearest to a mode's own frequency there
  /// beside its width: damping that begins between two speeds can take the mode away from the order.
  Meeting meeting(Eigen::Index mode, double order, double speed) {
    constexpr int kMostSteps = 8;
    constexpr double kLeastSlope = 0.1;  // of the order beyond its mode, relative to the order [-]
    constexpr double kBeside = 1e-7;     // distance for the slope of the mode, relative to the speed [-]
    Meeting best;
    for (int step = 0; step < kMostSteps; ++step) {
      if (!(speed >= low_ && speed <= high_) || sweep_.modes.at(mode, speed) == 0.0) break;
      speed = known_or(speed);
      const std::complex<double> lambda = poles_.at(sweep_.modes, mode, speed).lambda[0];
      const double off = std::abs(order * speed - lambda.imag());
      const double distance = off / (std::abs(lambda.real()) + 2.0 * kSameSpeed * std::abs(lambda));
      if (distance < best.distance) best = {speed, lambda, distance};
      if (off <= kSameSpeed * lambda.imag()) break;
      // Newton's step, with the slope of the mode between the modes' speeds.
      const std::complex<double> below = sweep_.modes.at(mode, (1.0 - kBeside) * speed),
                                 above = sweep_.modes.at(mode, (1.0 + kBeside) * speed);
      const bool known = below != 0.0 && above != 0.0;
      const double slope = order - (known ? (above - below).imag() / (2.0 * kBeside * speed) : 0.0);
      speed -= (order * speed - lambda.imag()) / (std::abs(slope) > kLeastSlope * order ? slope : order);
    }
    return best;
  }
  /// Enters the critical of order number k in mode m, and the speeds of its middle and its flanks.
  void seed(Eigen::Index m, std::size_t k, double near) {
    const auto [speed, lambda, distance] = meeting(m, sweep_.orders[k], near);
    if (distance > 1.0) return;
    const double ratio = -lambda.real() / std::abs(lambda);
    if (std::abs(ratio) > kTooDamped) return;
    for (const SweepCritical& other : sweep_.criticals)
      if (other.mode == m && other.order == sweep_.orders[k] &&
          std::abs(other.speed - speed) <= kSameSeed * std::abs(lambda.real()) / other.order)
        return;
    response_.vibration((1.0 + LinearResponse::kNear) * speed, point_, static_cast<int>(k));
    if (response_.forces().isZero(0.0)) return;  // a gate that is closed here, loads that cancel
    SweepCritical critical;
    critical.mode = static_cast<int>(m);
    critical.order = sweep_.orders[k];
    critical.speed = speed;
    critical.frequency_Hz = to_hz(lambda.imag());
    // A mode that grows has a bounded steady vibration, as large as if it decayed as fast.
    critical.damping_ratio = std::abs(ratio) > kUndamped ? ratio : 0.0;
    sweep_.criticals.push_back(critical);
    numbers_.push_back(static_cast<int>(k));
    if (critical.damping_ratio == 0.0) {
      sweep_.criticals.back().amplitude = unbounded(speed, static_cast<int>(k));
      return;
    }
    const double width = std::abs(lambda.real()) / sweep_.orders[k];
    for (const double at : {speed - width, speed, speed + width})
      if (at > low_ && at < high_ && !is_near(at, kSameSeed * width)) curves_.emplace(at, solved(at));
  }
  void note_largest(const SweepPoint& point) {
    for (std::size_t c = 0; c < largest_.size(); ++c)
      if (const double here = point.half_range(static_cast<int>(c)); std::isfinite(here))
        largest_[c] = std::max(largest_[c], here);
  }
  /// Finds the orders in which any load has content, at either end of the speed range.
  void find_content() {
    has_content_.assign(sweep_.orders.size(), false);
    for (const SweepSection& section : sweep_.sections)
      for (std::size_t k = 0; k < has_content_.size(); ++k)
        has_content_[k] = has_content_[k] || !section.amplitude.row(static_cast<Eigen::Index>(k)).isZero(0.0);
  }
  /// The speeds of the sweep at which an order meets the mode's frequency: between two speeds of the modes at both of which it
  /// swings one at the most.
  std::vector<double> meets(Eigen::Index mode, double order) const {
    const SweepModes& modes = sweep_.modes;
    const auto above = [&](double speed) { return order * speed - modes.at(mode, speed).imag(); };
    std::vector<double> found;
    for (Eigen::Index i = 0; i < std::max<Eigen::Index>(modes.speeds.size() - 1, 1); ++i) {
      const bool constant = modes.speeds.size() == 1;
      if (modes.lambda(mode, i) == 0.0 || (!constant && modes.lambda(mode, i + 1) == 0.0)) continue;
      double low = (1.0 - kSameSpeed) * (constant ? low_ : modes.speeds[i]),
             high = (1.0 + kSameSpeed) * (constant ? high_ : modes.speeds[i + 1]);
      const bool rises = above(low) <= 0.0;
      if (!(rises ? above(high) >= 0.0 : above(high) < 0.0)) continue;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        ((above(middle) < 0.0) == rises ? low : high) = middle;
      }
      const double speed = known_or(std::clamp(0.5 * (low + high), low_, high_));
      if (found.empty() || speed > (1.0 + kSameSpeed) * found.back()) found.push_back(speed);
    }
    return found;
  }
  /// The speed, or that of the curves which it is but for rounding.
  double known_or(double speed) const {
    const auto known = curves_.lower_bound((1.0 - kSameSpeed) * speed);
    return known != curves_.end() && known->first <= (1.0 + kSameSpeed) * speed ? known->first : speed;
  }
  /// Whether a speed is known already. Modes that coincide meet an order at speeds that differ by rounding alone: all of them
  /// entered, the rounding of the curve would make a top of one of them, between neighbours without the curve's own top.
  bool is_near(double speed, double distance) const {
    const auto above = curves_.lower_bound(speed - distance);
    return above != curves_.end() && above->first <= speed + distance;
  }
  SweepPoint solved(double speed) {
    pause_();
    response_.vibration(speed, point_);
    response_.mean(speed, point_);
    sum_.extremes(point_.amplitude, extremes_);
    SweepPoint here{speed, point_.mean, point_.mean, point_.mean, point_.heat};
    for (Eigen::Index c = 0; c < here.mean.size(); ++c) {
      here.maximum[c] = extremes_[static_cast<std::size_t>(c)].max;
      here.minimum[c] = extremes_[static_cast<std::size_t>(c)].min;
    }
    note_largest(here);
    return here;
  }
  /// Enters infinite extremes at a speed at which an order meets an undamped mode, for each section that the mode
  /// moves. Returns the largest amplitude of the order there: infinite where the loads excite the mode.
  double unbounded(double speed, int order) {
    const LinearResponse::Resonance at = response_.resonance(speed, order);
    if (!at.excited) return std::abs(at.near.amplitude(order, most_moved(at.near.amplitude.row(order))));
    if (!curves_.contains(speed)) curves_[speed] = solved((1.0 + LinearResponse::kNear) * speed);
    SweepPoint& here = curves_[speed];
    here.speed = speed;
    for (Eigen::Index c = 0; c < here.maximum.size(); ++c)
      if (at.unbounded[static_cast<std::size_t>(c)])
        here.maximum[c] = kInfinite, here.minimum[c] = -kInfinite;
    return kInfinite;
  }
  /// Of a critical at which the order meets an undamped mode: infinite, unless the loads do not excite the mode.
  void find_undamped(SweepCritical& critical, int order) {
    const LinearResponse::Resonance at = response_.resonance(critical.speed, order);
    critical.section = most_moved(at.near.amplitude.row(order));
    for (std::size_t c = 0; c < sweep_.sections.size(); ++c) {
      const bool mine = at.excited && at.unbounded[c];
      critical.in_sections.push_back(
          {critical.speed,
           mine ? kInfinite : std::abs(at.near.amplitude(order, static_cast<Eigen::Index>(c))),
           mine ? kInfinite : 0.0});
    }
    critical.half_range = critical.own_amplitude = critical.amplitude;
    if (!std::isfinite(critical.amplitude)) return;
    critical.own_amplitude = 0.0;
    critical.half_range =
        one((1.0 + LinearResponse::kNear) * critical.speed, static_cast<std::size_t>(critical.section));
  }
  void add_values(SweepPeak& peak) {
    const auto c = static_cast<Eigen::Index>(peak.section);
    const bool twists = !sweep_.sections[static_cast<std::size_t>(peak.section)].twist_unit.empty();
    pause_();
    response_.vibration(peak.speed, point_);
    response_.mean(peak.speed, point_);
    peak.mean = point_.mean[c];
    if (!std::isfinite(peak.half_range)) {
      peak.maximum = kInfinite, peak.minimum = -kInfinite;
      if (twists) peak.twist_half_range = kInfinite;
      return;
    }
    peak.heat = point_.heat[c];
    const SumExtremes& found = extremes_of(point_.amplitude, c);
    peak.maximum = found.max, peak.minimum = found.min;
    if (twists) peak.twist_half_range = extremes_of(point_.twist, c).half_range();
  }
  const SumExtremes& extremes_of(const Eigen::MatrixXcd& amplitudes, Eigen::Index column) {
    const std::complex<double>* sum = amplitudes.col(column).data();
    sum_.extremes(std::span(&sum, 1), extremes_);
    return extremes_.front();
  }
  double one(double speed, std::size_t section) {
    pause_();
    response_.vibration(speed, point_);
    return extremes_of(point_.amplitude, static_cast<Eigen::Index>(section)).half_range();
  }
  /// The section with the largest amplitude, among those with the unit of the first one.
  int most_moved(const Eigen::RowVectorXcd& amplitudes) const {
    int best = 0;
    double most = -1.0;
    for (std::size_t c = 0; c < sweep_.sections.size(); ++c) {
      const double part = std::abs(amplitudes[static_cast<Eigen::Index>(c)]);
      if (sweep_.sections[c].unit == sweep_.sections.front().unit && part > most)
        most = part, best = static_cast<int>(c);
    }
    return best;
  }
  /// Finds section, own amplitude and the sections' speeds of a critical at which the order meets a damped mode. In
  /// x = (o w - Im lambda) / |Re lambda| the amplitude is r / (1 + i x) + b0 + b1 x + b2 x^2, from r, the mode's residue
  /// over |Re lambda|, and values at x = -1, 0, 1.
  void find_own_parts(SweepCritical& critical, int order) {
    const DampedPole pole = poles_.at(sweep_.modes, critical.mode, critical.speed);
    const std::complex<double> lambda = pole.lambda[0], i(0.0, 1.0);
    const double width = std::abs(lambda.real()) / critical.order;
    const auto at = [&](double x) -> Eigen::RowVectorXcd {
      pause_();
      response_.vibration(critical.speed + x * width, point_, order);
      if (response_.direction() < 0.0) return point_.amplitude.row(order).conjugate();
      return point_.amplitude.row(order);
    };
    const Eigen::RowVectorXcd below = at(-1.0), above = at(1.0), here = at(0.0);
    const Eigen::RowVectorXcd own = response_.amplitudes_of(poles_.pairs.residue(pole, response_.forces())) /
                                    std::abs(lambda.real()),
                              rest = here - own, slope = 0.5 * (above - below) + 0.5 * i * own,
                              bend = 0.5 * (above + below - own) - rest;
    critical.section = most_moved(own);
    critical.own_amplitude = std::abs(own[critical.section]);
    for (Eigen::Index c = 0; c < own.size(); ++c) {
      const auto amplitude = [&](double x) {
        return std::abs(own[c] / (1.0 + i * x) + rest[c] + (slope[c] + bend[c] * x) * x);
      };
      constexpr double kTolerance = 1e-6;
      SweepCritical::InSection in{critical.speed, std::abs(here[c]), std::abs(own[c])};
      if (in.is_mode()) {
        const BracketedMaximum found = bracketed_maximum(-1.0, 0.0, 1.0, kTolerance, amplitude);
        if (std::abs(found.at) < 1.0 - 2.0 * kTolerance)
          in.speed += found.at * width, in.amplitude = found.value;
      }
      critical.in_sections.push_back(in);
    }
  }

  LinearResponse& response_;
  TrigonometricSum& sum_;
  const std::function<void()>& pause_;
  LinearSweep& sweep_;
  DampedPoles& poles_;
  double low_, high_;
  std::map<double, SweepPoint> curves_;  // of the grid and the seeds, by speed
  std::vector<double> largest_;          // largest finite half range of each section
  std::vector<bool> has_content_;
  std::vector<int> numbers_;  // number of the order of each critical speed
  LinearResponse::Point point_;
  std::vector<SumExtremes> extremes_;
};

}  // namespace

DampedPole DampedPoles::at(const SweepModes& modes, Eigen::Index mode, double speed) {
  Eigen::Index nearest = 0;
  (modes.speeds.array() - speed).abs().minCoeff(&nearest);
  const auto column = static_cast<std::size_t>(nearest);
  const Eigen::VectorXcd& all = lambda[column];
  const auto coincides = [](std::complex<double> a, std::complex<double> b) {
    return std::abs(a - b) <= kCoincide * std::abs(b);
  };
  std::vector<Eigen::Index> same{mode};
  for (Eigen::Index j = 0; j < all.size(); ++j)
    if (j != mode && coincides(all[j], all[mode])) same.push_back(j);
  DampedPole pole{{}, all(same), shapes[column](Eigen::all, same)};
  // Asked for only where it is needed: loads that are called are looked at anew at another speed.
  const auto damping_of = [&](double at, std::complex<double> of) { return matrices(at, of.imag()).damping; };
  if (modes.speeds.size() == 1) {
    pole.damping = damping_of(modes.speeds[nearest], all[mode]);
    return pole;
  }
  const std::complex<double> guess = modes.at(mode, speed);
  DampedPole here{{}, pole.lambda, pole.shapes};
  Eigen::Index count = 0;
  for (Eigen::Index j = 0; j < pole.lambda.size(); ++j) {
    std::complex<double> found = guess;
    Eigen::VectorXcd shape = pole.shapes.col(j);
    bool good = pairs.refine([&](double omega) { return matrices(speed, omega); }, found, shape);
    for (Eigen::Index k = 0; k < all.size() && j == 0; ++k)
      good &=
          all[k] == 0.0 || coincides(all[k], all[mode]) || std::abs(found - all[k]) > std::abs(found - guess);
    if (!good && j == 0) {
      pole.damping = damping_of(modes.speeds[nearest], all[mode]);
      pole.lambda.setConstant(guess);
      return pole;
    }
    if (!good || (j > 0 && !coincides(found, here.lambda[0]))) continue;
    here.lambda[count] = found;
    here.shapes.col(count++) = shape;
  }
  here.damping = damping_of(speed, here.lambda[0]);
  here.lambda = here.lambda.head(count).eval();
  here.shapes = here.shapes.leftCols(count).eval();
  return here;
}

void find_sweep_peaks(const System& system, LinearResponse& response, TrigonometricSum& sum,
                      const std::function<void()>& wanted_pause, LinearSweep& sweep) {
  const std::function<void()> pause = wanted_pause ? wanted_pause : [] {};
  DampedPoles poles{DampedPairs(system, response.complex_stiffnesses().held()),
                    [&](double speed, double omega) { return response.mode_matrices(speed, omega); }};
  find_sweep_modes(system, response, pause, sweep, poles);
  Search search(response, sum, pause, sweep, poles);
  search.seed();
  search.find_peaks();
  search.find_heat();
  search.find_criticals();
}

}  // namespace drev
