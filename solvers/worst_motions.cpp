#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kSameSpeed = 1e-9;  // difference of one and the same speed relative to it [-]

/// Stable, or not judged: a train of many unknowns.
bool may_stay(const SweptMotion& motion) { return motion.stable || !motion.judged; }

/// Extremes without the mean, and what belongs to them.
void put_motion(const SweptMotion& motion, Eigen::Index section, Eigen::Index at, SweepSection& s) {
  s.mean[at] = motion.mean[section];
  s.maximum[at] = motion.maximum[section] - motion.mean[section];
  s.minimum[at] = motion.minimum[section] - motion.mean[section];
  s.heat[at] = motion.heat[section];
  s.amplitude.col(at) = motion.amplitude.col(section);
  s.twist_mean[at] = motion.twist_mean[section];
  s.twist_half_range[at] = 0.5 * (motion.twist_maximum[section] - motion.twist_minimum[section]);
}

void put_motion(const SweptMotion& motion, double half_range, SweepPeak& peak) {
  const auto section = static_cast<Eigen::Index>(peak.section);
  peak.speed = motion.speed, peak.half_range = half_range;
  peak.mean = motion.mean[section];
  peak.maximum = motion.maximum[section] - motion.mean[section];
  peak.minimum = motion.minimum[section] - motion.mean[section];
  peak.heat = motion.heat[section];
  peak.twist_half_range = 0.5 * (motion.twist_maximum[section] - motion.twist_minimum[section]);
}

SweepSection empty_section(const NonlinearSweep::Section& given, std::size_t orders, std::size_t speeds) {
  SweepSection s;
  s.name = given.name, s.unit = given.unit, s.twist_unit = given.twist_unit, s.contact = given.contact;
  const auto columns = static_cast<Eigen::Index>(speeds);
  s.amplitude.setZero(static_cast<Eigen::Index>(orders), columns);
  for (Vector* values : {&s.mean, &s.maximum, &s.minimum, &s.maximum_angle, &s.minimum_angle, &s.twist_mean,
                         &s.twist_half_range, &s.heat})
    values->setZero(columns);
  return s;
}

/// Of each section the highest point of stable curves between two neighbouring speeds, where it is above both.
void add_peaks(const NonlinearSweep& given, LinearSweep& sweep) {
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const Vector half = sweep.sections[c].half_range();
    for (std::size_t i = 0; i + 1 < sweep.speeds.size(); ++i) {
      SweepPeak best;
      best.section = static_cast<int>(c);
      best.half_range = std::max(half[static_cast<Eigen::Index>(i)], half[static_cast<Eigen::Index>(i + 1)]);
      for (const SweptBranch& branch : given.branches)
        for (const SweptMotion& motion : branch.motions) {
          if (!may_stay(motion) || motion.speed <= sweep.speeds[i] || motion.speed >= sweep.speeds[i + 1])
            continue;
          const double here = motion.half_range()[static_cast<Eigen::Index>(c)];
          if (here > best.half_range) put_motion(motion, here, best);
        }
      if (best.speed > 0.0) sweep.peaks.push_back(best);
    }
  }
  std::stable_sort(sweep.peaks.begin(), sweep.peaks.end(), [](const SweepPeak& a, const SweepPeak& b) {
    return a.section != b.section ? a.section < b.section : a.half_range > b.half_range;
  });
}

/// The points of stable curves beside the speeds. Where another stable curve, straight between its points, is above a section's
/// half range, the section's values are not numbers.
void add_points(const NonlinearSweep& given, LinearSweep& sweep) {
  const auto asked = [&](double speed) {
    return std::any_of(sweep.speeds.begin(), sweep.speeds.end(),
                       [speed](double s) { return std::abs(s - speed) <= kSameSpeed * s; });
  };
  for (const SweptBranch& branch : given.branches)
    for (const SweptMotion& m : branch.motions)
      if (may_stay(m) && m.speed > sweep.speeds.front() && m.speed < sweep.speeds.back() && !asked(m.speed))
        sweep.points.push_back({m.speed, m.mean, m.maximum - m.mean, m.minimum - m.mean, m.heat});
  const auto slower = [](const SweepPoint& p, double speed) { return p.speed < speed; };
  std::stable_sort(sweep.points.begin(), sweep.points.end(),
                   [](const SweepPoint& a, const SweepPoint& b) { return a.speed < b.speed; });
  for (const SweptBranch& branch : given.branches)
    for (std::size_t i = 0; i + 1 < branch.motions.size(); ++i) {
      const auto [low, high] = std::minmax(branch.motions[i], branch.motions[i + 1],
                                           [](const auto& a, const auto& b) { return a.speed < b.speed; });
      if (!may_stay(low) || !may_stay(high)) continue;
      const Vector from = low.half_range(), to = high.half_range();
      for (auto p = std::lower_bound(sweep.points.begin(), sweep.points.end(),
                                     std::nextafter(low.speed, high.speed), slower);
           p != sweep.points.end() && p->speed < high.speed; ++p) {
        const double part = (p->speed - low.speed) / (high.speed - low.speed);
        for (Eigen::Index c = 0; c < from.size(); ++c)
          if (from[c] + part * (to[c] - from[c]) > p->half_range(static_cast<int>(c)))
            p->mean[c] = p->maximum[c] = p->minimum[c] = p->heat[c] = std::nan("");
      }
    }
}

}  // namespace

WorstMotions worst_motions(const NonlinearSweep& given) {
  struct Answer {
    std::vector<const SweptMotion*> stable;
    const SweptRun* run = nullptr;
  };
  WorstMotions found;
  std::vector<Answer> answers;
  for (const double speed : given.speeds) {
    const auto here = [speed](double other) { return std::abs(other - speed) <= kSameSpeed * speed; };
    Answer answer;
    for (const SweptBranch& branch : given.branches)
      for (const SweptMotion& motion : branch.motions)
        if (motion.asked && may_stay(motion) && here(motion.speed)) answer.stable.push_back(&motion);
    for (const SweptRun& run : given.runs)
      if (here(run.speed) && run.reason.empty()) answer.run = &run;
    if (answer.stable.empty() && !answer.run) {
      found.missing.push_back(speed);
      continue;
    }
    if (answer.stable.empty()) found.by_runs.push_back(speed);
    found.sweep.speeds.push_back(speed);
    answers.push_back(std::move(answer));
  }
  LinearSweep& sweep = found.sweep;
  sweep.orders = given.orders;
  sweep.cycle = given.turns;
  const std::size_t speeds = sweep.speeds.size();
  for (std::size_t c = 0; c < given.sections.size(); ++c) {
    SweepSection& s =
        sweep.sections.emplace_back(empty_section(given.sections[c], given.orders.size(), speeds));
    const auto section = static_cast<Eigen::Index>(c);
    for (std::size_t i = 0; i < speeds; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (answers[i].stable.empty()) {
        const SweptRun& run = *answers[i].run;
        s.mean[at] = run.mean[section];
        s.heat[at] = s.twist_mean[at] = s.twist_half_range[at] = std::nan("");
        s.maximum[at] = run.highest[section] - run.mean[section];
        s.minimum[at] = run.lowest[section] - run.mean[section];
        continue;
      }
      const SweptMotion& worst =
          **std::max_element(answers[i].stable.begin(), answers[i].stable.end(),
                             [section](const SweptMotion* a, const SweptMotion* b) {
                               return a->half_range()[section] < b->half_range()[section];
                             });
      put_motion(worst, section, at, s);
    }
  }
  add_peaks(given, sweep);
  add_points(given, sweep);
  return found;
}

}  // namespace drev
