#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "solvers/sweeper.hpp"

namespace drev {

namespace {

constexpr int kFewestHarmonics = 24;
constexpr int kMostRows = 1100;         // rows of Newton's matrix with more harmonics: 0.3 s a step
constexpr int kMostExcitedRows = 2000;  // where the loads' highest harmonic takes more: 2 s a step
constexpr double kCarried =
    1e-2;                        // part of a section's vibration that may lie beyond the harmonics of a curve
constexpr double kOrder = 1e-3;  // part of a section's vibration from which an order is given by default
constexpr int kSampleSpeeds = 16;  // speeds at which the loads' content is looked at
constexpr int kMostLaws = 50;      // laws, each 49 rows with the fewest harmonics: 3 s a step
constexpr int kProbe = 192;        // harmonics of the linear motion that the first number is read from
constexpr double kTail = 1e-5;     // part of the linear motion beyond the harmonics taken
constexpr int kMostBranches = 12;
constexpr double kSameFold = 1e-7;   // relative difference of speed of a fold found with more harmonics
constexpr int kDefaultOrders = 12;   // harmonics of a cycle of up to kShortCycle turns
constexpr int kHalfOrders = 24;      // 0.5 to 12 by halves
constexpr int kMostOrders = 64;      // orders given by default
constexpr double kShortCycle = 2.0;  // turns

using Kind = BranchEvent::Kind;

}  // namespace

Sweeper::Sweeper(const System& system, const NonlinearSweepOptions& options)
    : system_(system), options_(options) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/sweep", findings);
  check.increasing("speeds", options.speeds, "rad/s");
  check.increasing("orders", options.orders, "");
  if (options.speeds.size() < 2)
    check.fail("number of speeds", std::to_string(options.speeds.size()), "",
               "must be at least two, for a model that is not linear");
  else
    check.positive("speeds", options.speeds.front(), "rad/s");
  if (!options.orders.empty()) check.positive("orders", options.orders.front(), "");
  check.non_negative("turns", options.turns, "");
  check.within("tolerance", options.tolerance, 1e-12, 0.1, "");
  check.within("run_cycles", options.run_cycles, 40, 1e6, "");
  check.non_negative("threads", options.threads, "");
  if (system.size() == 0)
    findings.push_back({system.name(), "", "", "", "every node is prescribed: nothing vibrates"});
  if (!system.reference())
    findings.push_back({system.name(), "", "", "",
                        "no shaft turns nominally: orders need a reference shaft (nominal_speed or "
                        "constant_speed)"});
  sections_ = std::make_unique<MotionSections>(find_section_rows(system, options.sections, findings));
  if (!findings.empty()) throw ModelError(std::move(findings));
  sweep_.turns = options.turns > 0.0 ? options.turns : cycle_turns(system, options.speeds);
  LawBalance balance(system, sweep_.turns > 0.0 ? sweep_.turns : 1.0, options.balance, findings);
  if (sweep_.turns == 0.0 && findings.empty())
    check.fail("turns", "0", "",
               "must be given: laws and loads have no common cycle of 20 turns of the reference shaft");
  if (balance.inputs() == 0 && findings.empty())
    check.fail("laws", "none", "",
               "must be at least one that is no straight line; sweep_linear() is for "
               "linear models");
  if (balance.inputs() > kMostLaws)
    check.fail("laws", std::to_string(balance.inputs()), "",
               "and loads that follow the twist of their node are too many, at most " +
                   std::to_string(kMostLaws) +
                   "; loads over the nominal angle (twist_feedback = false) do not count, closed contacts "
                   "(drev sweep --contact closed) neither");
  if (!findings.empty()) throw ModelError(std::move(findings));
  sweep_.speeds = options.speeds;
  sweep_.orders = options.orders;
  excited_ = std::make_unique<ExcitedLines>(system, sweep_.turns, options.balance, sections_->sections());
  excited_harmonics_ = excited_->fewest(sample_speeds(), kCarried);
  if (sweep_.orders.empty()) set_orders();
  low_ = options.speeds.front();
  high_ = options.speeds.back();
  for (const SectionRows& rows : sections_->sections())
    sweep_.sections.push_back({rows.name, rows.unit, rows.twist_unit, rows.contact});
  sweep_.floating_parts = balance.mean().floating();
  if (system.size() <= FloquetProduct::kMostUnknowns) stability_ = std::make_unique<FloquetProduct>(system);
}

/// Some of the speeds asked for, with the first and the last.
std::vector<double> Sweeper::sample_speeds() const {
  const std::size_t count = std::min<std::size_t>(options_.speeds.size(), kSampleSpeeds);
  std::vector<double> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(options_.speeds[i * (options_.speeds.size() - 1) / (count - 1)]);
  return some;
}

/// Orders that are harmonics of the cycle: those by halves, the first of a short cycle, and what loads and laws excite.
void Sweeper::set_orders() {
  std::set<int> lines;
  for (int half = 1; half <= kHalfOrders; ++half) {
    const double line = 0.5 * half * sweep_.turns;
    if (std::abs(line - std::round(line)) < 1e-9 * line) lines.insert(static_cast<int>(std::round(line)));
  }
  for (int n = 1; n <= kDefaultOrders && sweep_.turns <= kShortCycle; ++n) lines.insert(n);
  for (const int n : excited_->excited(sample_speeds(), kOrder))
    if (lines.size() < kMostOrders) lines.insert(n);
  for (const int n : lines) sweep_.orders.push_back(n / sweep_.turns);
}

/// Difference of a motion from that with half the harmonics, or what loads excite beyond its harmonics, whichever is more.
double Sweeper::error_of(const MotionSections::Figures& coarse, const MotionSections::Figures& fine,
                         int cycles, int harmonics, double speed) {
  const Vector beyond = excited_->beyond(speed, harmonics / cycles);
  double error = largest_difference(coarse, fine);
  for (Eigen::Index c = 0; c < beyond.size(); ++c) {
    const double size = fine.samples.col(c).cwiseAbs().maxCoeff();
    if (size > 0.0) error = std::max(error, beyond[c] / size);
  }
  return error;
}

/// Of curves: with twice as many Newton's matrix has its most rows.
int Sweeper::most_harmonics(const LawBalance& balance) const {
  return std::max(kFewestHarmonics, kMostRows / (4 * balance.inputs()));
}

bool Sweeper::first_of(int cycles) const {
  return std::none_of(traced_.begin(), traced_.end(),
                      [&](const TracedBranch& one) { return one.cycles == cycles; });
}

SweepFamily& Sweeper::family(int cycles) {
  const auto found = families_.find(cycles);
  if (found != families_.end()) {
    found->second.balance->set_harmonics(found->second.harmonics);
    return found->second;
  }
  SweepFamily& made = families_[cycles];
  std::vector<Finding> none;
  made.balance = std::make_unique<LawBalance>(system_, cycles * sweep_.turns, options_.balance, none);
  for (const double order : sweep_.orders) {
    const double line = order * cycles * sweep_.turns;
    const bool whole = std::abs(line - std::round(line)) < 1e-9 * line;
    made.lines.push_back(whole ? static_cast<int>(std::round(line)) : 1 << 30);
  }
  // As many harmonics as the linear motion has, and as many again, for the kinks.
  const int most = most_harmonics(*made.balance);
  int needed = kFewestHarmonics;
  if (cycles == 1) {
    const int probe = std::min(kProbe, most);
    made.balance->set_harmonics(probe);
    Vector x;
    const Eigen::Index block = 2 * probe + 1;
    if (made.balance->linear_start(low_, x))
      for (int i = 0; i < made.balance->inputs(); ++i) {
        const Vector of = x.segment(i * block + 1, block - 1);
        const double size = of.norm();
        for (int n = probe; n > needed / 2 && size > 0.0; --n)
          if (of.segment(2 * n - 2, 2).norm() > kTail * size) needed = std::max(needed, 2 * n);
      }
  } else {
    needed = cycles * family(1).harmonics;
  }
  SweepFamily& again = families_[cycles];
  const int excited = cycles * excited_harmonics_;
  again.resolved = excited_harmonics_ <= excited_->lines() &&
                   (excited <= most || again.balance->inputs() * (2 * excited + 1) <= kMostExcitedRows);
  again.harmonics = std::max(std::min(needed, most), again.resolved ? excited : 0);
  again.balance->set_harmonics(again.harmonics);
  return again;
}

BranchTracer Sweeper::tracer(int cycles) {
  return {*family(cycles).balance,
          stability_.get(),
          {.low = low_, .high = high_, .cycles = cycles, .most_rows = kMostRows}};
}

void Sweeper::trace(int cycles, double speed, const Vector& x, bool from_run) {
  if (traced_.size() >= static_cast<std::size_t>(kMostBranches)) return;
  traced_.push_back({cycles, tracer(cycles).trace(speed, x), from_run ? speed : 0.0});
  collect(traced_.size() - 1);
}

/// Whether a curve of single cycles passes the motion.
bool Sweeper::known(double speed, const Vector& x) {
  for (const TracedBranch& one : traced_) {
    if (one.cycles != 1) continue;
    BranchTracer tracer = this->tracer(1);
    for (std::size_t i = 0; i + 1 < one.branch.points.size(); ++i) {
      const BranchPoint &a = one.branch.points[i], &b = one.branch.points[i + 1];
      if ((a.speed - speed) * (b.speed - speed) > 0.0 || a.speed == b.speed) continue;
      const auto here = tracer.between(a, b, speed);
      if (here && (here->x - x).norm() <= 1e-6 * x.norm()) return true;
    }
  }
  return false;
}

/// The motion with twice the harmonics, which the balance then has; none: it is not found.
std::optional<Vector> Sweeper::widened(LawBalance& balance, double speed, const Vector& x) const {
  const int before = balance.harmonics();
  Vector wide = x;
  if (balance.double_harmonics(speed, wide)) return wide;
  balance.set_harmonics(2 * before);
  wide = balance.resized(x, before, 2 * before);
  BranchTracer tracer(balance, nullptr, {.low = low_, .high = high_});
  if (balance.size() > kMostRows || !tracer.solve(speed, wide)) return std::nullopt;
  return wide;
}

/// Whether a motion is one of the train, not of its few harmonics: it is the same with twice as many. The first of a number
/// of cycles gives their curves as many as it needs.
bool Sweeper::holds(int cycles, double speed, Vector& x) {
  SweepFamily& of = family(cycles);
  LawBalance& balance = *of.balance;
  const bool first = first_of(cycles);
  MotionSections::Figures coarse, fine;
  double error = NAN;
  while (sections_->find(balance, x, speed, of.lines, coarse)) {
    const auto wide = widened(balance, speed, x);
    error = wide && sections_->find(balance, *wide, speed, of.lines, fine)
                ? error_of(coarse, fine, cycles, balance.harmonics(), speed)
                : NAN;
    if (!first || !(error > kTraced) || balance.size() > kMostRows) break;
    of.harmonics *= 2;
    x = *wide;
  }
  balance.set_harmonics(of.harmonics);
  return error <= NonlinearSweep::kTrusted;
}

/// A curve from the motion with closed contacts, where there is one that is not known.
bool Sweeper::start_at(double speed) {
  Vector x;
  if (!family(1).resolved) return false;
  BranchTracer tracer = this->tracer(1);
  if (!family(1).balance->linear_start(speed, x) || !tracer.solve(speed, x)) return false;
  if (!holds(1, speed, x)) return false;
  if (!known(speed, x)) trace(1, speed, x);
  return true;
}

SweptMotion Sweeper::motion_of(int cycles, const BranchPoint& point) const {
  SweepFamily& of = families_.at(cycles);
  of.balance->set_harmonics(point.harmonics);
  MotionSections::Figures figures;
  SweptMotion motion;
  motion.speed = point.speed;
  motion.judged = stability_ != nullptr;
  motion.stable = point.stable;
  motion.multiplier = point.multiplier;
  motion.harmonics = point.harmonics;
  motion.error = std::nan("");
  const auto count = static_cast<Eigen::Index>(sections_->sections().size());
  for (Vector* values : {&motion.maximum, &motion.minimum, &motion.mean, &motion.twist_mean,
                         &motion.twist_maximum, &motion.twist_minimum, &motion.heat})
    values->setConstant(count, std::nan(""));
  motion.amplitude.setConstant(static_cast<Eigen::Index>(of.lines.size()), count, std::nan(""));
  if (sections_->find(*of.balance, point.x, point.speed, of.lines, figures))
    static_cast<MotionFigures&>(motion) = figures;
  of.balance->set_harmonics(of.harmonics);
  return motion;
}

/// The motion with twice as many harmonics until its error is small enough.
SweptMotion Sweeper::asked_for(int cycles, const BranchPoint& point) {
  SweepFamily& of = family(cycles);
  LawBalance& balance = *of.balance;
  SweptMotion motion = motion_of(cycles, point);
  motion.asked = true;
  balance.set_harmonics(point.harmonics);
  Vector x = point.x;
  MotionSections::Figures coarse, fine;
  if (!sections_->find(balance, x, point.speed, of.lines, coarse)) return motion;
  BranchTracer tracer(balance, stability_.get(), {.low = low_, .high = high_});
  while (true) {
    const auto wide = widened(balance, point.speed, x);
    if (!wide || !sections_->find(balance, *wide, point.speed, of.lines, fine)) break;
    const BranchPoint judged = tracer.judged(point.speed, *wide);
    static_cast<MotionFigures&>(motion) = fine;
    motion.error = error_of(coarse, fine, cycles, judged.harmonics, point.speed);
    motion.harmonics = judged.harmonics;
    motion.multiplier = judged.multiplier;
    motion.stable = judged.stable;
    if (motion.error <= options_.tolerance || 2 * balance.size() > kMostRows) break;
    x = *wide;
    if (!tracer.solve(point.speed, x) || !sections_->find(balance, x, point.speed, of.lines, coarse)) break;
  }
  balance.set_harmonics(of.harmonics);
  return motion;
}

void Sweeper::collect(std::size_t number) {
  const TracedBranch& traced = traced_[number];
  SweptBranch branch;
  branch.turns = traced.cycles * sweep_.turns;
  branch.whole = traced.branch.whole;
  branch.run_speed = traced.run_speed;
  BranchTracer tracer = this->tracer(traced.cycles);
  const auto& points = traced.branch.points;
  const int harmonics = family(traced.cycles).harmonics;
  const auto at_base = [&](BranchPoint point) {
    if (point.harmonics != harmonics)
      point.x = family(traced.cycles).balance->resized(point.x, point.harmonics, harmonics);
    point.harmonics = harmonics;
    return point;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool asked = false;
    for (const double speed : options_.speeds)
      asked = asked || std::abs(points[i].speed - speed) <= kSameSpeed * speed;
    branch.motions.push_back(asked ? asked_for(traced.cycles, at_base(points[i]))
                                   : motion_of(traced.cycles, points[i]));
    if (i + 1 == points.size()) break;
    const BranchPoint from = at_base(points[i]), to = at_base(points[i + 1]);
    std::vector<double> between;
    for (const double speed : options_.speeds)
      if ((speed - from.speed) * (speed - to.speed) < 0.0 &&
          std::min(std::abs(speed - from.speed), std::abs(speed - to.speed)) > kSameSpeed * speed)
        between.push_back(speed);
    if (from.speed > to.speed) std::reverse(between.begin(), between.end());
    for (const double speed : between) {
      family(traced.cycles);
      if (const auto point = tracer.between(from, to, speed))
        branch.motions.push_back(asked_for(traced.cycles, *point));
    }
  }
  const int place = static_cast<int>(sweep_.branches.size());
  for (const BranchEvent& event : traced.branch.events) {
    const BranchChange kind = event.kind == Kind::fold              ? BranchChange::fold
                              : event.kind == Kind::contact         ? BranchChange::contact
                              : event.kind == Kind::period_doubling ? BranchChange::period_doubling
                              : event.kind == Kind::branching       ? BranchChange::branching
                                                                    : BranchChange::torus;
    sweep_.changes.push_back(
        {kind, place, event.speed, event.error, motion_of(traced.cycles, event.point), {}});
  }
  sweep_.branches.push_back(std::move(branch));
}

void Sweeper::find_jumps() {
  for (SweptChange& change : sweep_.changes) {
    if (change.kind != BranchChange::fold) continue;
    std::vector<Vector> others;
    bool ends_stable = false;
    for (std::size_t b = 0; b < traced_.size(); ++b) {
      const auto& points = traced_[b].branch.points;
      BranchTracer tracer = this->tracer(traced_[b].cycles);
      const int harmonics = family(traced_[b].cycles).harmonics;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        BranchPoint from = points[i], to = points[i + 1];
        const auto is_fold = [&](const BranchPoint& point) {
          return std::abs(point.speed - change.speed) <= kSameFold * change.speed;
        };
        const bool own = static_cast<int>(b) == change.branch && (is_fold(from) || is_fold(to));
        if (own) ends_stable = ends_stable || (is_fold(from) ? to : from).stable;
        if (own || (from.speed - change.speed) * (to.speed - change.speed) >= 0.0) continue;
        for (BranchPoint* point : {&from, &to})
          if (point->harmonics != harmonics) {
            point->x = family(traced_[b].cycles).balance->resized(point->x, point->harmonics, harmonics);
            point->harmonics = harmonics;
          }
        family(traced_[b].cycles);
        const auto here = tracer.between(from, to, change.speed);
        if (here && here->stable) others.push_back(motion_of(traced_[b].cycles, *here).half_range());
      }
    }
    if (ends_stable && others.size() == 1) change.jumps_to = others.front();
  }
}

/// Where no curve can contain all that loads excite: what it would take, and what would be missing.
void Sweeper::note_excess() {
  const SweepFamily& of = family(1);
  if (of.resolved) return;
  const bool enough = excited_harmonics_ <= excited_->lines();
  const int most = std::max(of.harmonics, (kMostExcitedRows / of.balance->inputs() - 1) / 2);
  sweep_.excess = {true, enough ? excited_harmonics_ : 0, most,
                   excited_->share_beyond(sample_speeds(), most)};
}

NonlinearSweep Sweeper::run() {
  note_excess();
  start_at(high_);
  if (tell(0.25)) start_at(low_);
  for (const double speed : options_.speeds)
    if (!stable_at(speed) && tell(0.4)) start_at(speed);
  if (options_.runs && (stability_ != nullptr || sweep_.branches.empty())) fill_with_runs();
  for (const double speed : options_.speeds)
    if (!any_at(speed)) sweep_.unsolved.push_back(speed);
  // Speeds of runs that had not settled may have got a curve from another run.
  std::erase_if(sweep_.runs, [&](const SweptRun& run) { return stable_at(run.speed); });
  find_jumps();
  return std::move(sweep_);
}

NonlinearSweep sweep_nonlinear(const System& system, const NonlinearSweepOptions& options) {
  refuse_controllers(system, "a sweep of speeds");
  return Sweeper(system, options).run();
}

}  // namespace drev
