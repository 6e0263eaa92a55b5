#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/sweeper.hpp"

namespace drev {

namespace {

constexpr double kPerturbation = 1e-3;
constexpr double kRepresented =
    0.3;  // of a section's largest value: the few harmonics' distance from the run

/// X of the laws' inputs, of states at even times over the cycles.
Vector harmonics_of(const std::vector<Vector>& motion, const LawBalance& balance, int harmonics) {
  const auto all = static_cast<int>(motion.size());
  const Eigen::Index block = 2 * harmonics + 1;
  Vector x = Vector::Zero(balance.inputs() * block);
  for (int s = 0; s < all; ++s) {
    const double psi = balance.direction() * kTwoPi * s / all;
    const Vector inputs = balance.inputs_of(motion[static_cast<std::size_t>(s)]);
    for (int n = 0; n <= harmonics; ++n) {
      const double part = (n == 0 ? 1.0 : 2.0) / all, c = part * std::cos(n * psi),
                   sine = part * std::sin(n * psi);
      for (int i = 0; i < balance.inputs(); ++i) {
        if (n > 0) x[i * block + 2 * n - 1] += c * inputs[i];
        x[i * block + 2 * n] -= (n > 0 ? sine : -c) * inputs[i];
      }
    }
  }
  return x;
}

}  // namespace

const SweptMotion* Sweeper::nearest(double speed) const {
  const SweptMotion* best = nullptr;
  for (const SweptBranch& branch : sweep_.branches)
    for (const SweptMotion& motion : branch.motions)
      if (motion.z.size() > 0 &&
          (best == nullptr || std::abs(motion.speed - speed) < std::abs(best->speed - speed)))
        best = &motion;
  return best;
}

bool Sweeper::any_at(double speed) const {
  for (const SweptBranch& branch : sweep_.branches)
    for (const SweptMotion& motion : branch.motions)
      if (motion.asked && std::abs(motion.speed - speed) <= kSameSpeed * speed) return true;
  return false;
}

bool Sweeper::stable_at(double speed) const {
  for (const SweptBranch& branch : sweep_.branches)
    for (const SweptMotion& motion : branch.motions)
      if (motion.asked && std::abs(motion.speed - speed) <= kSameSpeed * speed &&
          (motion.stable || !motion.judged))
        return true;
  return false;
}

/// How far the extremes of a run's harmonics are from the run's own, beside each section's largest value.
double Sweeper::away_from(const SweptRun& run, LawBalance& balance, const Vector& x,
                          const std::vector<int>& lines) const {
  MotionSections::Figures figures;
  if (!sections_->find(balance, x, run.speed, lines, figures)) return INFINITY;
  double most = 0.0;
  for (Eigen::Index c = 0; c < run.highest.size(); ++c) {
    const double size = std::max(run.highest[c], -run.lowest[c]);
    for (const double off : {figures.maximum[c] - run.highest[c], figures.minimum[c] - run.lowest[c]})
      if (off != 0.0) most = std::max(most, std::abs(off) / size);
  }
  return most;
}

/// A curve from the motion that a run settled on, by its own harmonics, as many as it needs. True: it is new, and stable
/// there.
bool Sweeper::start_from(const CycleRunResult& result) {
  const double speed = result.run.speed;
  const int cycles = result.run.repeats;
  if (cycles == 0) return false;
  SweepFamily& of = family(cycles);
  if (!of.resolved) return false;
  LawBalance& balance = *of.balance;
  const int before = of.harmonics, most = std::max(most_harmonics(balance), before);
  const bool first = first_of(cycles);
  const Vector all = harmonics_of(result.motion, balance, most);
  Vector x;
  double away = INFINITY;
  while (true) {
    balance.set_harmonics(of.harmonics);
    x = balance.resized(all, most, of.harmonics);
    away = away_from(result.run, balance, x, of.lines);
    if (!first || away <= kTraced || of.harmonics >= most) break;
    of.harmonics = std::min(2 * of.harmonics, most);
  }
  const std::size_t curves = traced_.size();
  if (away <= kRepresented && tracer(cycles).solve(speed, x) && holds(cycles, speed, x))
    trace(cycles, speed, x, true);
  if (traced_.size() > curves) return stable_at(speed);
  if (first) of.harmonics = before;
  return false;
}

/// Runs at the speeds without a stable motion, in rounds: one, then twice as many at a time as long as no curve is
/// found that may answer others. The rounds are the same whatever the number of threads.
void Sweeper::fill_with_runs() {
  std::vector<double> left;
  for (const double speed : options_.speeds)
    if (!stable_at(speed)) left.push_back(speed);
  const double count = static_cast<double>(left.size());
  CycleRunOptions of{.cycles = options_.run_cycles, .tolerance = options_.tolerance};
  for (const SectionRows& row : sections_->sections()) of.channels.push_back(row.name);
  of.samples = 4 * std::max(most_harmonics(*family(1).balance), family(1).harmonics);
  of.floating = floating_parts_of(system_, family(1).balance->mean());
  for (std::size_t round = 1; !left.empty(); round = std::min(round, left.size())) {
    std::vector<RunStart> starts;
    for (std::size_t i = 0; i < round; ++i) {
      RunStart start{.speed = left[i], .z = {}, .v = {}};
      if (const SweptMotion* near = nearest(left[i])) {
        start.z = (1.0 + kPerturbation) * near->z;
        start.v = (1.0 + kPerturbation) * near->v;
      }
      starts.push_back(std::move(start));
    }
    const double done = count - static_cast<double>(left.size());
    const auto found = run_at_speeds(system_, starts, sweep_.turns, of, options_.threads, [&](double part) {
      return tell(0.5 + 0.5 * (done + part * static_cast<double>(round)) / count);
    });
    if (!found) return;
    bool new_curve = false;
    for (std::size_t i = 0; i < round; ++i) {
      if (stable_at(left[i])) continue;
      if (start_from((*found)[i]))
        new_curve = true;
      else
        sweep_.runs.push_back((*found)[i].run);
    }
    left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(round));
    std::erase_if(left, [&](double speed) { return stable_at(speed); });
    round = new_curve ? 1 : 2 * round;
  }
}

}  // namespace drev
