#include <drev/core/error.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/load.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "solvers/periodic/linear_response.hpp"
#include "solvers/periodic/sweep_peaks.hpp"

namespace drev {

namespace {

constexpr int kMostUnknowns = 400;   // unknowns up to which damped modes are dense; beyond, one by one
constexpr int kFirstModes = 16;      // number of undamped modes that are found first
constexpr int kMostModes = 128;      // largest number of undamped modes that are found
constexpr int kModeSpeeds = 9;       // number of speeds for modes if loads depend on the speed
constexpr int kMostModeSpeeds = 33;  // largest number with those at which their damping bends
constexpr double kOneSpeed = 1e-10;  // relative difference of speeds that are one but for rounding [-]
constexpr double kSameValue =
    1e-9;                       // difference of damping or stiffness that is rounding, relative to it [-]
constexpr double kBend = 1e-2;  // the same, off the line between two speeds, that takes one between them [-]

/// For each mode of `next` the number of the mode of `last` that it continues, by shape: largest |x' y| / (|x| |y|) first,
/// before modes that do not swing at present those that do. -1: none, it is a mode more.
std::vector<Eigen::Index> matched(const Eigen::MatrixXcd& last, const std::vector<char>& swings,
                                  const Eigen::MatrixXcd& next) {
  struct Pair {
    bool swings;
    double likeness;
    Eigen::Index from, to;
  };
  std::vector<Pair> pairs;
  for (Eigen::Index i = 0; i < last.cols(); ++i)
    for (Eigen::Index j = 0; j < next.cols(); ++j)
      pairs.push_back({swings[static_cast<std::size_t>(i)] != 0,
                       std::abs(last.col(i).dot(next.col(j))) / (last.col(i).norm() * next.col(j).norm()), i,
                       j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.swings != b.swings ? a.swings : a.likeness > b.likeness;
  });
  std::vector<Eigen::Index> from(static_cast<std::size_t>(next.cols()), -1);
  std::vector<bool> taken(static_cast<std::size_t>(last.cols()), false);
  for (const Pair& pair : pairs) {
    if (from[static_cast<std::size_t>(pair.to)] >= 0 || taken[static_cast<std::size_t>(pair.from)]) continue;
    from[static_cast<std::size_t>(pair.to)] = pair.from;
    taken[static_cast<std::size_t>(pair.from)] = true;
  }
  return from;
}

/// The way of modes from the mean torque that complex stiffnesses carry in time to that at the speed.
DampedPairs::Path path_at(LinearResponse& response, double speed) {
  return [&response, speed](double part, double omega) { return response.mode_matrices(speed, omega, part); };
}

/// Speeds between given ones at which a load that states how steep it may be over a range is steeper than at these: a gate may open
/// and close between two of them.
class HiddenSlopes {
 public:
  HiddenSlopes(const LoadTerm& load, double ratio) : load_(*load.load), ratio_(ratio) {}

  std::vector<double> find(const std::vector<double>& speeds) {
    std::vector<double> slopes;
    for (const double speed : speeds) slopes.push_back(steepest_at(speed));
    look(speeds, slopes, 0, speeds.size() - 1);
    return found_;
  }

 private:
  static constexpr double kMore = 1.25;   // times as steep as the points show that is more than they show [-]
  static constexpr double kOther = 1e-2;  // difference from the line between two points that is a bend [-]
  static constexpr int kAngles = 16, kDepth = 12, kMostLooks = 4000;

  /// Largest size of its slope by the speed at this one of the reference shaft [N m s/rad].
  double steepest_at(double speed) const {
    double most = 0.0;
    for (int i = 0; i < kAngles; ++i)
      most = std::max(most, std::abs(load_
                                         .evaluate({.nominal_angle = kTwoPi * (i + 0.5) / kAngles,
                                                    .speed = ratio_ * speed,
                                                    .nominal_speed = ratio_ * speed})
                                         .dtorque_dspeed));
    return most;
  }
  /// Whether it may be steeper between a and b than `shown`.
  bool hides(double a, double b, double shown) const {
    const Interval speed{std::min(ratio_ * a, ratio_ * b), std::max(ratio_ * a, ratio_ * b)};
    const auto most = load_.steepest({{0.0, 0.0}, {0.0, kTwoPi * OrderContent::kMostTurns}, speed, speed});
    return most && most->by_speed > kMore * shown;
  }
  void look(const std::vector<double>& speeds, const std::vector<double>& slopes, std::size_t from,
            std::size_t to) {
    const double shown = *std::max_element(slopes.begin() + static_cast<std::ptrdiff_t>(from),
                                           slopes.begin() + static_cast<std::ptrdiff_t>(to) + 1);
    if (from == to || !hides(speeds[from], speeds[to], shown)) return;
    if (to == from + 1) return divide(speeds[from], slopes[from], speeds[to], slopes[to], kDepth);
    const std::size_t middle = (from + to) / 2;
    look(speeds, slopes, from, middle);
    look(speeds, slopes, middle, to);
  }
  void divide(double a, double slope_a, double b, double slope_b, int depth) {
    if (depth == 0 || ++looks_ > kMostLooks || !hides(a, b, std::max(slope_a, slope_b))) return;
    const double middle = 0.5 * (a + b), slope = steepest_at(middle);
    if (std::abs(slope - 0.5 * (slope_a + slope_b)) > kOther * std::max({slope, slope_a, slope_b}))
      found_.push_back(middle);
    divide(a, slope_a, middle, slope, depth - 1);
    divide(middle, slope, b, slope_b, depth - 1);
  }

  const Load& load_;
  double ratio_;
  int looks_ = 0;
  std::vector<double> found_;
};

/// The speeds at which the modes are found, and those between which something jumps.
class ModeSpeeds {
 public:
  ModeSpeeds(const System& system, LinearResponse& response, const std::vector<double>& speeds)
      : system_(system),
        response_(response),
        content_(system, {}, none_),
        low_(speeds.front()),
        high_(speeds.back()) {
    if ((!response.content().follows_speed() && !response.follows_mean_torque()) || speeds.size() < 2) return;
    for (int i = 0; i < kModeSpeeds; ++i) at_[low_ + (high_ - low_) * i / (kModeSpeeds - 1)] = true;
    const auto add = [&](double speed) {
      const auto near = at_.lower_bound((1.0 - kOneSpeed) * speed);
      if (near == at_.end() || near->first > (1.0 + kOneSpeed) * speed) at_[speed] = false;
    };
    for (const double speed : speeds) add(speed);
    if (response.follows_mean_torque())
      for (int i = 1; i < kTorqueSpeeds; ++i) add(low_ + (high_ - low_) * i / kTorqueSpeeds);
    std::vector<double> known;
    for (const auto& [speed, take] : at_) known.push_back(speed);
    for (const LoadTerm* load : content_.loads())
      for (const double speed :
           HiddenSlopes(*load, response.direction() * system.ratio(load->node)).find(known))
        at_.emplace(speed, false);
    find_values();
    find_jumps();
    for (const double speed : jumps_) at_.emplace(speed, false);
    if (!jumps_.empty()) find_values();
  }

  /// The middle one where at all of the sweep's speeds each load damps alike and the mean torque leaves each stiffness as it is;
  /// else kModeSpeeds of equal distance, and of the sweep's speeds, and of those between them at which a load is steeper, those
  /// between which that bends.
  Vector find() const {
    const Vector middle = Vector::Constant(1, 0.5 * (low_ + high_));
    if (at_.empty()) return middle;
    const Eigen::MatrixXd values = values_.topRows(values_.rows() - loads());
    if (!((values.colwise() - values.col(0)).cwiseAbs().maxCoeff() > kSameValue)) return middle;
    std::vector<double> at;
    std::vector<char> taken;
    for (const auto& [speed, take] : at_) at.push_back(speed), taken.push_back(take);
    for (int count = kModeSpeeds; count < kMostModeSpeeds; ++count) {
      double most = kBend;
      std::size_t bent = at.size();
      for (std::size_t from = 0, to = 0; from + 1 < at.size(); from = to) {
        for (to = from + 1; !taken[to];) ++to;
        for (std::size_t i = from + 1; i < to; ++i) {
          const double part = (at[i] - at[from]) / (at[to] - at[from]);
          const auto column = [&](std::size_t j) { return values.col(static_cast<Eigen::Index>(j)); };
          const double off =
              (column(i) - (1.0 - part) * column(from) - part * column(to)).cwiseAbs().maxCoeff();
          if (off > most) most = off, bent = i;
        }
      }
      if (bent == at.size()) break;
      taken[bent] = 1;
    }
    std::vector<double> found;
    for (std::size_t i = 0; i < at.size(); ++i)
      if (taken[i]) found.push_back(at[i]);
    return Eigen::Map<const Vector>(found.data(), static_cast<Eigen::Index>(found.size()));
  }
  /// Speeds on both sides of those at which a load's slope or size jumps: the kinks of curves, the ends of gates.
  const std::vector<double>& jumps() const { return jumps_; }

 private:
  static constexpr int kTorqueSpeeds = 256;  // of equal distance at which mean torques are looked at

  Eigen::Index loads() const { return static_cast<Eigen::Index>(content_.loads().size()); }

  /// Of loads their damping; of complex stiffnesses what they are beyond the matrices, relative to the stated one; of loads their size.
  Vector values_at(double speed) {
    const std::size_t stiffnesses = system_.frequency_terms().size();
    Vector values(2 * loads() + static_cast<Eigen::Index>(stiffnesses));
    Eigen::Index load = 0;
    for (const OrderContent::Content& here : content_.at(response_.direction() * speed)) {
      values[load] = here.speed_slope;
      values[values.size() - loads() + load++] = here.rms;
    }
    for (std::size_t t = 0; t < stiffnesses; ++t)
      values[load++] = response_.mode_stiffness(t, speed, high_).real() / stated_stiffness(t);
    return values;
  }
  /// At rest, under the load in time.
  double stated_stiffness(std::size_t term) const {
    const FrequencyStiffness& own = *system_.frequency_terms()[term].stiffness;
    return own.static_stiffness() + own.static_beyond_matrices();
  }
  /// At all speeds; of loads damping and size relative to the largest.
  void find_values() {
    Eigen::Index column = 0;
    for (const auto& [speed, take] : at_) {
      const Vector here = values_at(speed);
      if (column == 0) values_.resize(here.size(), static_cast<Eigen::Index>(at_.size()));
      values_.col(column++) = here;
    }
    scale_ = Vector::Ones(values_.rows());
    if (loads() == 0) return;
    const auto set = [&](const auto& rows, auto&& scale) {
      if (const double largest = rows.cwiseAbs().maxCoeff(); largest > 0.0) scale.setConstant(1.0 / largest);
    };
    set(values_.topRows(loads()), scale_.head(loads()));
    set(values_.bottomRows(loads()), scale_.tail(loads()));
    values_ = (scale_.asDiagonal() * values_).eval();
  }
  /// A jump is where halving the distance of two speeds does not bring their values together.
  void find_jumps() {
    constexpr double kBeside = 4.0;    // change over that beside it that may be a jump [-]
    constexpr int kSoon = 8;           // halvings after which a change that is none has shrunk
    constexpr double kShrunk = 0.25;   // to this part [-]
    constexpr double kLocated = 1e-9;  // distance of the two sides of a jump relative to the speed [-]
    std::vector<double> at;
    for (const auto& [speed, take] : at_) at.push_back(speed);
    const auto change = [](const Vector& a, const Vector& b) { return (b - a).cwiseAbs().maxCoeff(); };
    const auto step = [&](std::size_t i) {
      if (i + 1 >= at.size()) return 0.0;
      const auto column = static_cast<Eigen::Index>(i);
      return change(values_.col(column), values_.col(column + 1));
    };
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const double whole = step(i), beside = std::min(i > 0 ? step(i - 1) : 0.0, step(i + 1));
      if (!(whole > kBend && whole > kBeside * beside)) continue;
      double a = at[i], b = at[i + 1], left = whole;
      Vector at_a = values_.col(static_cast<Eigen::Index>(i)),
             at_b = values_.col(static_cast<Eigen::Index>(i) + 1);
      for (int halving = 1; b - a > kLocated * b && !(halving > kSoon && left < kShrunk * whole); ++halving) {
        const double middle = 0.5 * (a + b);
        const Vector here = scale_.cwiseProduct(values_at(middle));
        const double below = change(at_a, here), above = change(here, at_b);
        left = std::max(below, above);
        (below >= above ? b : a) = middle;
        (below >= above ? at_b : at_a) = here;
      }
      if (left >= kShrunk * whole) jumps_.insert(jumps_.end(), {a, b});
    }
  }

  const System& system_;
  LinearResponse& response_;
  std::vector<Finding> none_;
  OrderContent content_;
  double low_, high_;
  std::map<double, bool> at_;  // speeds; true: one at which the modes are found
  Eigen::MatrixXd values_;
  Vector scale_;
  std::vector<double> jumps_;
};

/// Takes a growth at column number i of the modes, if it is faster.
void note_growth(const SweepModes& modes, Eigen::Index i, const Growth& here, LinearSweep& sweep) {
  if (!(here.rate > sweep.growth.rate)) return;
  sweep.growth = here;
  if (modes.speeds.size() > 1) sweep.growth_speed = modes.speeds[i];
}

/// Numbers the modes by their |lambda| at the first speed at which each swings, and gives all columns all of them.
void number_modes(SweepModes& modes, DampedPoles& poles) {
  const Eigen::Index count = poles.lambda.back().size();
  std::vector<double> size(static_cast<std::size_t>(count), 0.0);
  for (const Eigen::VectorXcd& lambda : poles.lambda)
    for (Eigen::Index m = 0; m < lambda.size(); ++m)
      if (double& here = size[static_cast<std::size_t>(m)]; here == 0.0) here = std::abs(lambda[m]);
  std::vector<Eigen::Index> order(size.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return size[static_cast<std::size_t>(a)] < size[static_cast<std::size_t>(b)];
  });
  modes.lambda.resize(count, modes.speeds.size());
  for (std::size_t i = 0; i < poles.lambda.size(); ++i) {
    Eigen::VectorXcd lambda = Eigen::VectorXcd::Zero(count);
    Eigen::MatrixXcd shapes = Eigen::MatrixXcd::Zero(poles.shapes[i].rows(), count);
    lambda.head(poles.lambda[i].size()) = poles.lambda[i];
    shapes.leftCols(poles.shapes[i].cols()) = poles.shapes[i];
    poles.lambda[i] = lambda(order);
    poles.shapes[i] = shapes(Eigen::all, order);
    modes.lambda.col(static_cast<Eigen::Index>(i)) = poles.lambda[i];
  }
}

SweepModes follow_modes(const System& system, LinearResponse& response, const std::vector<double>& speeds,
                        double highest, const std::function<void()>& pause, LinearSweep& sweep,
                        DampedPoles& poles) {
  SweepModes modes;
  const ModeSpeeds mode_speeds(system, response, speeds);
  modes.speeds = mode_speeds.find();
  poles.jumps = mode_speeds.jumps();
  Eigen::MatrixXcd shapes(system.size(), 0);  // of each mode, where it swung last
  std::vector<char> swings;                   // for each: it does at the last speed
  for (Eigen::Index i = 0; i < modes.speeds.size(); ++i) {
    pause();
    DampedModeSet set = solve_damped_modes(system, {.damping = load_damping(system, modes.speeds[i])});
    Eigen::VectorXcd found = lambda_of(set);
    if (response.follows_mean_torque()) {
      if (!poles.pairs.take_all_on(path_at(response, modes.speeds[i]), highest, pause, found, set.vectors))
        sweep.modes_note =
            "some modes were lost under the stiffness that couplings have at a speed: a resonance that is "
            "narrower than the distance of the speeds can be missed";
      for (Eigen::Index m = 0; m < found.size(); ++m)
        set.modes[static_cast<std::size_t>(m)].lambda = found[m];
    }
    note_growth(modes, i, fastest_growth(system, set), sweep);
    std::vector<Eigen::Index> from = matched(shapes, swings, set.vectors);
    const Eigen::Index more = std::count(from.begin(), from.end(), -1);
    shapes.conservativeResize(Eigen::NoChange, shapes.cols() + more);
    swings.assign(static_cast<std::size_t>(shapes.cols()), 0);
    Eigen::Index next = shapes.cols() - more;
    Eigen::VectorXcd& lambda = poles.lambda.emplace_back(Eigen::VectorXcd::Zero(shapes.cols()));
    for (std::size_t m = 0; m < from.size(); ++m) {
      const Eigen::Index mode = from[m] >= 0 ? from[m] : next++;
      lambda[mode] = found[static_cast<Eigen::Index>(m)];
      shapes.col(mode) = set.vectors.col(static_cast<Eigen::Index>(m));
      swings[static_cast<std::size_t>(mode)] = lambda[mode] != 0.0;
    }
    poles.shapes.push_back(shapes);
  }
  number_modes(modes, poles);
  return modes;
}

/// The modes of systems with many unknowns: undamped modes up to the highest frequency of an order, each
/// iterated to its damped mode (damped_pairs.hpp). Modes that do not converge, or that converge to one
/// already found, are 0.
SweepModes follow_pairs(const System& system, LinearResponse& response, const std::vector<double>& speeds,
                        double highest, const std::function<void()>& pause, LinearSweep& sweep,
                        DampedPoles& poles) {
  const int all = elastic_mode_count(system, Contact::closed);
  ModeSet undamped;
  for (int count = std::min(all, kFirstModes);; count = std::min({all, 2 * count, kMostModes})) {
    undamped = solve_modes(system, {.count = count});
    if (count == std::min(all, kMostModes) || undamped.omega(count - 1) > highest) break;
  }
  DampedPairs& pairs = poles.pairs;
  SweepModes modes;
  const ModeSpeeds mode_speeds(system, response, speeds);
  modes.speeds = mode_speeds.find();
  poles.jumps = mode_speeds.jumps();
  modes.lambda.setZero(undamped.count(), modes.speeds.size());
  std::vector<Eigen::VectorXcd> shapes;
  std::vector<std::complex<double>> last;
  for (int m = 0; m < undamped.count(); ++m) {
    shapes.emplace_back(undamped.vectors.col(m).cast<std::complex<double>>());
    last.emplace_back(0.0, undamped.omega(m));
  }
  const int steps = response.follows_mean_torque() ? DampedPairs::kFewSteps : 1;
  for (Eigen::Index i = 0; i < modes.speeds.size(); ++i) {
    Eigen::VectorXcd& found = poles.lambda.emplace_back(Eigen::VectorXcd::Zero(undamped.count()));
    Eigen::MatrixXcd& of_unknowns = poles.shapes.emplace_back(system.size(), undamped.count());
    for (std::size_t m = 0; m < shapes.size(); ++m) {
      const auto mode = static_cast<Eigen::Index>(m);
      pause();
      std::complex<double> lambda = last[m];
      Eigen::VectorXcd shape = shapes[m];
      const bool settled = pairs.take_on(path_at(response, modes.speeds[i]), steps, lambda, shape);
      of_unknowns.col(mode) = shape;
      // What it does not swing as is no guess for the next speed; nor is where a way has ended that begins at the mean torque in time.
      if (!settled) continue;
      found[mode] = lambda;
      if (steps == 1) last[m] = lambda, shapes[m] = shape;
      const bool known = ((modes.lambda.col(i).head(mode).array() - lambda).abs() <
                          DampedPairs::kSameMode * std::abs(lambda))
                             .any();
      if (!known) modes.lambda(mode, i) = lambda;
    }
    Growth here;
    for (const std::complex<double> lambda : modes.lambda.col(i)) here.note(lambda);
    note_growth(modes, i, here, sweep);
  }
  return modes;
}

/// Which elements have another stiffness in the amplitudes of the sweep than in its modes; empty: none.
std::string fixed_stiffness_note(const System& system) {
  std::vector<std::string> names;
  for (const FrequencyTerm& term : system.frequency_terms())
    if (term.stiffness->amplitudes().size() > 1)
      names.push_back(system.element_instances()[idx(index(term.element))].name);
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return names.empty() ? ""
                       : "modes, and where orders meet them, have the stiffness of " + list +
                             " at its at_amplitude; amplitudes and peaks have that under the amplitude at "
                             "each speed, and the peaks say where the vibration is largest";
}

}  // namespace

void find_sweep_modes(const System& system, LinearResponse& response, const std::function<void()>& pause,
                      LinearSweep& sweep, DampedPoles& poles) {
  try {
    const double highest = sweep.orders.back() * sweep.speeds.back();
    sweep.modes = system.size() > kMostUnknowns
                      ? follow_pairs(system, response, sweep.speeds, highest, pause, sweep, poles)
                      : follow_modes(system, response, sweep.speeds, highest, pause, sweep, poles);
    const Eigen::Index count = sweep.modes.lambda.rows();
    if (system.size() > kMostUnknowns && count == kMostModes &&
        sweep.modes.lambda.row(count - 1).imag().maxCoeff() < highest)
      sweep.modes_note =
          "only the lowest " + std::to_string(kMostModes) +
          " modes are sought: a resonance above them that is narrower than the distance of the "
          "speeds can be missed";
  } catch (const SolverError& error) {
    sweep.modes_note = std::string(error.what()) +
                       ": a resonance that is narrower than the distance of the speeds can be missed";
  }
  if (const std::string fixed = fixed_stiffness_note(system); !fixed.empty())
    sweep.modes_note += (sweep.modes_note.empty() ? "" : "; ") + fixed;
}

}  // namespace drev
