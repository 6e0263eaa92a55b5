#include "solvers/periodic/load_probes.hpp"

#include <drev/core/law/knotted_load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>

namespace drev {

namespace {

/// Halves the parts of a load that bounds its slopes, always the one that may hide most: a load whose bounds are loose costs
/// kMostLooks, not the sight of its other parts.
class SlopeLook {
 public:
  SlopeLook(const Load& load, double speed, LoadProbes& probes)
      : load_(load), speed_(speed), probes_(probes) {}

  void over(double low, double high) {
    double shown = 0.0;
    for (const LoadProbes::Probe& probe : probes_.at) shown = std::max(shown, look(probe.angle).slope);
    consider(look(low), look(high), shown);
    for (int looks = 0; looks < kMostLooks && !parts_.empty() && counts(parts_.top().may); ++looks) {
      const Part part = parts_.top();
      parts_.pop();
      const Place middle = look(0.5 * (part.from.angle + part.to.angle));
      probes_.at.push_back({middle.angle, middle.angle - part.from.angle});
      consider(part.from, middle, 0.0);
      consider(middle, part.to, 0.0);
    }
    for (; !parts_.empty(); parts_.pop()) done_.push_back({parts_.top().from, parts_.top().to});
    for (const auto& [from, to] : done_)
      if (std::abs(to.torque - from.torque) > kSeen * (most_ - least_))
        probes_.finest = std::min(probes_.finest, to.angle - from.angle);
  }

 private:
  static constexpr double kMore = 2.0;        // times as steep as its ends show that a part may be [-]
  static constexpr double kNothing = 1e-4;    // change that does not count, over the range seen [-]
  static constexpr double kRounding = 1e-9;   // the same over the largest torque [-]
  static constexpr double kSeen = 1e-4;       // change that samples must meet, over the load's range [-]
  static constexpr double kNarrowest = 1e-7;  // part that is not halved: a jump [rad]
  static constexpr int kMostLooks = 1500;

  struct Place {
    double angle = 0.0, torque = 0.0, slope = 0.0;  // slope: its size
  };
  struct Part {
    double may = 0.0;  // change that it may hide, at most
    Place from, to;
    bool operator<(const Part& other) const { return may < other.may; }
  };

  bool counts(double change) const {
    return change > std::max(kNothing * (most_ - least_), kRounding * std::max(most_, -least_));
  }
  Place look(double angle) {
    const LoadResponse r = load_.evaluate({.nominal_angle = angle, .speed = speed_, .nominal_speed = speed_});
    most_ = std::max(most_, r.torque);
    least_ = std::min(least_, r.torque);
    return {angle, r.torque, std::abs(r.dtorque_dangle)};
  }
  void consider(const Place& from, const Place& to, double shown) {
    const double width = to.angle - from.angle;
    const Interval speed{speed_, speed_};
    const double bound = load_.steepest({{0.0, 0.0}, {from.angle, to.angle}, speed, speed})->by_angle;
    const double steepest = std::max({shown, from.slope, to.slope});
    if (width > kNarrowest && bound > kMore * steepest)
      parts_.push({bound * width, from, to});
    else
      done_.emplace_back(from, to);
  }

  const Load& load_;
  double speed_;
  LoadProbes& probes_;
  std::priority_queue<Part> parts_;
  std::vector<std::pair<Place, Place>> done_;
  double most_ = -std::numeric_limits<double>::infinity(), least_ = -most_;
};

}  // namespace

LoadProbes probes_of(const Load& load, double speed, int turns) {
  constexpr double kStart = 0.37, kStep = 0.911;  // rad: no division of a turn into equal parts hits these
  constexpr double kInside = 0.381966;            // where in its piece an angle stands [-]
  constexpr double kAhead = 1e-9;                 // step past a knot that was found [rad]
  constexpr std::size_t kMostPieces = 1 << 16;
  LoadProbes probes;
  for (int i = 0; i < LoadProbes::kFirst; ++i) probes.at.push_back({kStart + kStep * i, 1.0});
  const double end = kStart + turns * kTwoPi;
  const auto add = [&](double low, double high) {
    probes.at.push_back({low + kInside * (high - low), high - low});
  };
  if (const std::optional<LoadTable> table = load.table()) {
    const std::span<const double> x = table->arguments;
    for (std::size_t i = 0; i < x.size(); ++i)
      add(x[i] - table->phase, (i + 1 < x.size() ? x[i + 1] : x[0] + table->period) - table->phase);
  } else if (const auto* knotted = dynamic_cast<const KnottedLoad*>(&load)) {
    for (LoadProbes::Probe& probe : probes.at) {
      const CubicPiece piece = knotted->piece(probe.angle, 1.0, speed);
      probe.width = std::min(probe.width, piece.high - piece.low);
    }
    for (double at = kStart, next = at; at < end && probes.at.size() < kMostPieces; at = next) {
      next = std::clamp(knotted->piece(at, 1.0, speed).high, at + kAhead, end + kAhead);
      add(at, next);
    }
  } else if (load.depends_on_motion() &&
             load.steepest({{0.0, 0.0}, {0.0, 0.0}, {speed, speed}, {speed, speed}})) {
    probes.finest = end - kStart;
    SlopeLook(load, speed, probes).over(kStart, end);
  }
  return probes;
}

}  // namespace drev
