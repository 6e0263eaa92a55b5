#include "solvers/exact/friction_series.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dense/factorization.hpp"
#include "solvers/contact/friction_complementarity.hpp"
#include "solvers/run/run_verdict.hpp"

namespace drev {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// A slip speed is zero, relative to the speeds it is summed from or to the largest so far.
constexpr double kAtRest = 1e-13;
// Rounding that turns a locked freewheel backward, relative to the same speeds.
constexpr double kLocked = 1e-9;
// A slip acceleration is zero, relative to the terms that it is summed from.
constexpr double kNoAcceleration = 1e-12;
constexpr double kSumRounding = 1e-14;  // rounding of a sum, relative to its terms
constexpr double kGrowing = 4.0;        // largest torque inside a step over the torque at its start
// What the stuck contacts leave of a contact that depends on them, relative to W_ii.
constexpr double kDependent = 1e-10;

double size_of(const std::vector<Entry>& row, const double* x) {
  double sum = 0.0;
  for (const Entry& e : row) sum += std::abs(e.coeff * x[e.index]);
  return sum;
}

void add_entry(std::vector<Entry>& row, int index, double coeff) {
  for (Entry& e : row)
    if (e.index == index) {
      e.coeff += coeff;
      return;
    }
  row.push_back({index, coeff});
}

/// |K| |z| + |C| |v| + |p|: the terms that forces are summed from.
Vector force_sizes(const System& system, const EvaluatedState& point) {
  Vector size = point.p.cwiseAbs();
  const SparseMatrix& pattern = system.pattern();
  for (int j = 0; j < pattern.cols(); ++j)
    for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s)
      size[pattern.innerIndexPtr()[s]] += std::abs(system.stiffness_values()[s] * point.state.z[j]) +
                                          std::abs(system.damping_values()[s] * point.state.v[j]);
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    for (const Entry& e : system.scalars()[j].z) size[e.index] += std::abs(e.coeff * point.responses[j].y);
  return size;
}

}  // namespace

FrictionSeries::FrictionSeries(const System& system) : system_(system) {
  if (system.frictions().empty()) return;
  TaylorSeries series(system);
  for (const FrictionTerm& term : system.frictions()) {
    Contact c;
    for (const Entry& e : term.nodes) {
      const NodeMap& map = system.node_map(e.index);
      for (const Entry& z : system.row_of(e.index)) add_entry(c.z, z.index, e.coeff * z.coeff);
      if (map.prescribed >= 0) add_entry(c.u, map.prescribed, e.coeff * map.coeff);
      c.nominal += e.coeff * system.ratio(e.index);
    }
    Vector row = Vector::Zero(system.size()), gain;
    for (const Entry& e : c.z) row[e.index] = e.coeff;
    series.solve_mass(row, gain);
    for (int k = 0; k < system.size(); ++k)
      if (gain[k] != 0.0) c.gain.push_back({k, gain[k]});
    c.torque.assign(TaylorSeries::kMaxDegree + 1, 0.0);
    c.slip = c.slip_size = c.torque;
    contacts_.push_back(std::move(c));
  }
  const auto n = static_cast<Eigen::Index>(contacts_.size());
  w_.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    Vector column = Vector::Zero(system.size());
    for (const Entry& e : contacts_[static_cast<std::size_t>(j)].gain) column[e.index] = e.coeff;
    for (Eigen::Index i = 0; i < n; ++i)
      w_(i, j) = value_along(contacts_[static_cast<std::size_t>(i)].z, column.data());
  }
  w_ = (0.5 * (w_ + w_.transpose())).eval();
  find_gears();
}

double FrictionSeries::slip_of(const Contact& c, const Assembler& assembler, const Vector& v) const {
  double w = value_along(c.z, v.data()) + c.nominal * assembler.nominal().rate;
  for (const Entry& e : c.u) w += e.coeff * assembler.prescribed(e.index).rate;
  return w;
}

FrictionSeries::Limits FrictionSeries::limits(std::size_t i, bool loose) const {
  if (law(i).rigid() || contacts_[i].tie >= 0) return {-kInfinite, kInfinite};
  if (law(i).one_way()) return {-kInfinite, 0.0};
  const double torque = law(i).sliding_torques().front();
  const double most = loose ? torque : torque * law(i).break_away();
  return {-most, most};
}

bool FrictionSeries::breaks_away(std::size_t i) const { return limits(i, false).high > limits(i, true).high; }

void FrictionSeries::find_segment(std::size_t i, double slip) {
  const std::vector<double>& speeds = law(i).slip_speeds();
  const auto above = std::upper_bound(speeds.begin() + 1, speeds.end(), std::abs(slip));
  contacts_[i].segment = static_cast<int>(above - speeds.begin()) - 1;
}

namespace {

/// tau(|w|) = at_zero + slope |w| on a segment of the table.
struct SlidingLine {
  double at_zero = 0.0, slope = 0.0;
};

/// What the bearing torques of a gear make of its loss.
double largest_constant(const GearLossRow& gear) {
  double largest = 0.0;
  for (const std::vector<GearLossRow::Line>* lines : {&gear.high, &gear.low})
    for (const GearLossRow::Line& line : *lines) largest = std::max(largest, std::abs(line.constant));
  return largest;
}

SlidingLine sliding_line(const Friction& law, int segment) {
  if (law.one_way()) return {};
  const std::vector<double>&v = law.slip_speeds(), &torque = law.sliding_torques();
  const auto k = idx(segment);
  if (k + 1 >= v.size()) return {torque[k], 0.0};
  const double slope = (torque[k + 1] - torque[k]) / (v[k + 1] - v[k]);
  return {torque[k] - slope * v[k], slope};
}

}  // namespace

double FrictionSeries::sliding(std::size_t i, double slip) const {
  const SlidingLine line = sliding_line(law(i), contacts_[i].segment);
  return contacts_[i].capacity[0] * (contacts_[i].sign * line.at_zero + line.slope * slip);
}

FrictionState FrictionSeries::state(int contact) const {
  const Contact& c = contacts_[idx(contact)];
  if (c.open) return FrictionState::open;
  if (c.stuck || c.tied) return FrictionState::stuck;
  return c.sign > 0 ? FrictionState::forward : FrictionState::backward;
}

void FrictionSeries::locate(const Assembler& assembler, EvaluatedState& point) {
  std::vector<char> at_rest(contacts_.size(), 0);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& c = contacts_[i];
    c.loose = c.root = false;
    at_rest[i] = c.stuck || c.tied;
  }
  if (!located_) check_ties(assembler, point.state.v);
  located_ = true;
  resolve(assembler, point, at_rest);
}

void FrictionSeries::resolve(const Assembler& assembler, EvaluatedState& point,
                             const std::vector<char>& at_rest, double slack) {
  resolved_ = true;
  const auto n = contacts_.size();
  Vector others = point.total;
  for (std::size_t i = 0; i < n; ++i)
    for (const Entry& e : contacts_[i].z)
      others[e.index] -=
          e.coeff * point.state.history[system_.frictions()[i].history_begin + FrictionHistory::kTorque];
  const Vector sizes = force_sizes(system_, point);
  Vector acceleration(static_cast<Eigen::Index>(n)), torque = Vector::Zero(static_cast<Eigen::Index>(n));
  std::vector<std::size_t> resting;
  std::vector<GearLossRow> gears;
  if (point.state.v.size() > 0)
    speed_scale_ = std::max(speed_scale_, point.state.v.lpNorm<Eigen::Infinity>());
  for (const FrictionTerm& term : system_.frictions())  // of the run that this one continues
    speed_scale_ =
        std::max(speed_scale_, point.state.history[term.history_begin + FrictionHistory::kSpeedScale]);
  for (std::size_t i = 0; i < n; ++i) {
    Contact& c = contacts_[i];
    const auto row = static_cast<Eigen::Index>(i);
    const Friction::Engagement g = law(i).engagement(assembler.time());
    c.capacity = g.terms;
    c.capacity[0] = std::max(0.0, c.capacity[0]);  // a formula's cubic may be below zero by its accuracy
    acceleration[row] = -value_along(c.gain, others.data()) + c.nominal * assembler.nominal().acceleration;
    for (const Entry& e : c.u) acceleration[row] += e.coeff * assembler.prescribed(e.index).acceleration;
    c.speed_rounding = patience_ * kSumRounding * size_of(c.gain, sizes.data());
    c.torque_rounding = c.speed_rounding / w_(row, row);
    if (c.rigid) {
      resting.push_back(i);
      continue;
    }
    const double slip = slip_of(c, assembler, point.state.v);
    double size = size_of(c.z, point.state.v.data()) + std::abs(c.nominal * assembler.nominal().rate);
    for (const Entry& e : c.u) size += std::abs(e.coeff * assembler.prescribed(e.index).rate);
    size = std::max(size, speed_scale_);
    c.open = c.capacity == std::array<double, 4>{} && !law(i).one_way();
    c.stuck = c.tied = false;
    if (c.open) continue;
    const bool locks = law(i).one_way() && slip < 0.0 && slip >= -kLocked * size;
    if (at_rest[i] || locks || std::abs(slip) <= std::max(kAtRest * size, slack)) {
      resting.push_back(i);
      c.segment = 0;
      if (c.tie >= 0) gears.push_back(gear_at(i, 0.0, true));
      continue;
    }
    c.root = false;
    c.sign = slip > 0.0 ? 1 : -1;
    if (c.sign < 0 && law(i).one_way())
      throw SolverError(at_time(system_.name(), assembler.time()) + "freewheel " +
                        system_.element_instances()[idx(index(element(static_cast<int>(i))))].name +
                        " turns in the direction that it locks, at " + to_text(slip) +
                        " rad/s: the speeds at the start must fit it");
    find_segment(i, slip);
    if (c.tie >= 0) {
      resting.push_back(i);
      gears.push_back(gear_at(i, slip, false));
    } else {
      torque[row] = sliding(i, slip);
    }
  }
  acceleration -= w_ * torque;
  const auto m = static_cast<Eigen::Index>(resting.size());
  std::vector<Eigen::Index> of(resting.begin(), resting.end());
  BoxComplementarity problem{.w = w_(of, of),
                             .r = acceleration(of),
                             .low = Vector::Zero(m),
                             .high = Vector::Zero(m),
                             .rounding = Vector::Zero(m)};
  for (GearLossRow& g : gears)  // rows of the system, until here
    for (Eigen::Index* row : {&g.loss, &g.tie}) *row = std::find(of.begin(), of.end(), *row) - of.begin();
  FrictionSolution found;
  for (bool settled = false; !settled;) {
    for (Eigen::Index k = 0; k < m; ++k) {
      const std::size_t i = resting[static_cast<std::size_t>(k)];
      const Limits most = limits(i, contacts_[i].loose);
      const double g = contacts_[i].capacity[0];
      problem.low[k] = law(i).one_way() ? most.low : g * most.low;
      problem.high[k] = g * most.high;
      problem.rounding[k] = contacts_[i].speed_rounding + kNoAcceleration * std::abs(problem.r[k]);
      for (Eigen::Index j = 0; j < m; ++j) {
        const std::size_t o = resting[static_cast<std::size_t>(j)];
        const double other = contacts_[o].capacity[0] * limits(o, false).high;
        if (!std::isfinite(other)) continue;
        problem.rounding[k] += kNoAcceleration * std::abs(problem.w(k, j) * other);
      }
      for (const GearLossRow& g : gears)
        problem.rounding[k] += kNoAcceleration * std::abs(problem.w(k, g.loss)) * largest_constant(g);
    }
    if (m > 0) found = solve_at(assembler.time(), problem, gears, resting);
    if (m > 0 && gears_)  // through ties, torques accelerate contacts far from them
      problem.rounding += kNoAcceleration * (problem.w.cwiseAbs() * found.lambda.cwiseAbs());
    // One breaks away at a time, the fastest: what it then carries is less, and the others are asked again.
    Contact* fastest = nullptr;
    double largest = 0.0;
    for (Eigen::Index k = 0; k < m; ++k) {
      Contact& c = contacts_[resting[static_cast<std::size_t>(k)]];
      if (c.loose || !breaks_away(resting[static_cast<std::size_t>(k)])) continue;
      if (std::abs(found.a[k]) <= std::max(problem.rounding[k], largest)) continue;
      largest = std::abs(found.a[k]);
      fastest = &c;
    }
    settled = fastest == nullptr;
    if (fastest) fastest->loose = true;
  }
  begin_stuck();
  if (m > 0) take(resting, found, problem, gears);
  factor_stuck();
  for (Eigen::Index k = 0; k < m; ++k) torque[of[static_cast<std::size_t>(k)]] = found.lambda[k];
  for (std::size_t i = 0; i < n; ++i) {
    const int begin = system_.frictions()[i].history_begin;
    point.state.history[begin + FrictionHistory::kTorque] = torque[static_cast<Eigen::Index>(i)];
    point.state.history[begin + FrictionHistory::kState] = static_cast<int>(state(static_cast<int>(i)));
    point.state.history[begin + FrictionHistory::kSpeedScale] = speed_scale_;
    contacts_[i].torque[0] = torque[static_cast<Eigen::Index>(i)];  // what add_to() judges a gear's slopes by
    if (contacts_[i].tie >= 0)
      note_gear(i, slip_of(contacts_[i], assembler, point.state.v), point.state.history);
  }
}

void FrictionSeries::begin_stuck() {
  stuck_.clear();
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    if (contacts_[i].rigid) stuck_.push_back(i);
}

void FrictionSeries::take(const std::vector<std::size_t>& of, const FrictionSolution& solution,
                          const BoxComplementarity& problem, const std::vector<GearLossRow>& gears) {
  std::vector<char> turns(of.size(), 0);
  for (std::size_t g = 0; g < gears.size(); ++g) {
    const auto k = static_cast<std::size_t>(gears[g].loss);
    turns[k] = gears[g].turns != 0;
    if (solution.line[g] >= 0) contacts_[of[k]].line = solution.line[g];
  }
  for (const bool between : {true, false})
    for (std::size_t k = 0; k < of.size(); ++k) {
      if ((solution.side[k] == 0) != between) continue;
      const auto row = static_cast<Eigen::Index>(k);
      Contact& c = contacts_[of[k]];
      if (c.rigid || turns[k]) continue;
      c.root = true;
      c.stuck = c.tied = false;
      const double a = solution.a[row];
      if (!between && std::abs(a) > problem.rounding[row]) {
        c.sign = a > 0.0 ? 1 : -1;
        c.segment = 0;
        continue;
      }
      factor_stuck();
      const bool dependent = depends_on_stuck(of[k]);
      int bound = solution.side[k];
      // A torque that stands on its bound may count as between where others can carry the load alone.
      if (between && dependent)
        bound = solution.lambda[row] <= problem.low[row]    ? -1
                : solution.lambda[row] >= problem.high[row] ? 1
                                                            : 0;
      c.tied = dependent && bound != 0;
      c.stuck = !c.tied;
      c.root_bound = bound;
      c.sign = bound > 0 ? 1 : -1;
      const Limits most = limits(of[k], c.loose);
      c.bound = bound > 0 ? most.high : most.low;
      if (c.stuck) stuck_.push_back(of[k]);
    }
}

bool FrictionSeries::depends_on_stuck(std::size_t i) const {
  const auto row = static_cast<Eigen::Index>(i);
  if (stuck_.empty()) return false;
  const std::vector<Eigen::Index> s(stuck_.begin(), stuck_.end());
  const Vector column = w_(s, row);
  return w_(row, row) - column.dot(stuck_inverse_ * column) <= kDependent * w_(row, row);
}

void FrictionSeries::factor_stuck() {
  any_on_line_ = gears_ && std::any_of(contacts_.begin(), contacts_.end(),
                                       [this](const Contact& c) { return on_line(c); });
  if (stuck_.empty()) return;
  const std::vector<Eigen::Index> s(stuck_.begin(), stuck_.end());
  const Eigen::MatrixXd w = w_(s, s);
  stuck_inverse_ = ldlt_solve(w, Eigen::MatrixXd(Eigen::MatrixXd::Identity(w.rows(), w.cols())));
}

void FrictionSeries::add_to(TaylorSeries& series, const LoadSeries& known, double t, double h) {
  h_ = h;
  known_degree_ = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& c = contacts_[i];
    const Friction::Engagement g = law(i).engagement(t);
    double power = 1.0, largest = 0.0;  // bound of g over the step
    for (std::size_t d = 0; d < g.terms.size(); ++d, power *= h) {
      c.capacity[d] = d == 0 ? std::max(0.0, g.terms[d]) : g.terms[d] * power;
      largest += std::abs(c.capacity[d]);
      if (d > 1 && c.capacity[d] != 0.0) known_degree_ = std::max(known_degree_, static_cast<int>(d));
    }
    c.known = {c.nominal * known.nominal()[1] / h, 2.0 * c.nominal * known.nominal()[2] / h};
    for (const Entry& e : c.u)
      for (std::size_t k = 0; k < 2; ++k)
        c.known[k] += static_cast<double>(k + 1) / h * e.coeff * known.prescribed(e.index)[k + 1];
    if (c.open || c.stuck || c.tied) continue;
    if (c.tie >= 0) {
      const LossValues v = loss_values(c, *law(i).gear_loss(), c.line);
      const double torque = std::abs(c.torque[0]) + std::abs(contacts_[idx(c.tie)].torque[0]);
      series.widen_damping((std::abs(v.bearing.slope) + kGrowing * std::abs(v.efficiency.slope) * torque) *
                           w_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
      continue;
    }
    const double slope = sliding_line(law(i), c.segment).slope;
    if (slope != 0.0)
      series.widen_damping(std::abs(slope) * largest *
                           w_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
  }
}

double FrictionSeries::add(const TaylorSeries& series, int k, double factor, double* term) {
  const auto d = idx(k - 2);
  const auto apply = [&](const Contact& c, double torque) {
    for (const Entry& e : c.gain) term[e.index] -= factor * e.coeff * torque;
  };
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& c = contacts_[i];
    if (d >= c.torque.size()) c.torque.resize(d + 1);
    if (d >= c.slip.size()) c.slip.resize(d + 1);
    c.torque[d] = 0.0;
    if (c.open || c.stuck || c.tie >= 0) continue;
    const double g = d < c.capacity.size() ? c.capacity[d] : 0.0;
    if (c.tied) {
      c.torque[d] = g * c.bound;
    } else {
      const SlidingLine line = sliding_line(law(i), c.segment);
      c.torque[d] = c.sign * line.at_zero * g;
      if (line.slope != 0.0) {
        c.slip[d] = slip_term(c, series, d);
        for (std::size_t j = 0; j <= std::min(d, c.capacity.size() - 1); ++j)
          c.torque[d] += line.slope * c.capacity[j] * c.slip[d - j];
      }
    }
    if (c.torque[d] != 0.0) apply(c, c.torque[d]);
  }
  if (any_on_line_) {
    for (std::size_t i = 0; i < contacts_.size(); ++i)
      if (on_line(contacts_[i])) add_gear(series, i, k, factor, term);
    if (d == 0) factor_series();
  }
  constexpr double kWholeTerm = std::numeric_limits<double>::infinity();
  if (stuck_.empty()) return kWholeTerm;
  const auto m = static_cast<Eigen::Index>(stuck_.size());
  Vector rest(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Contact& c = contacts_[stuck_[static_cast<std::size_t>(j)]];
    rest[j] = value_along(c.z, term) / factor + (d == 0 ? c.known[1] / h_ : 0.0);
  }
  const Vector torque = (any_on_line_ ? series_inverse_ : stuck_inverse_) * rest;
  const auto hold_by = [&](Contact& c, double more) {
    c.torque[d] += more;
    for (const Entry& e : c.gain) {
      term[e.index] -= factor * e.coeff * more;
      // What rounding leaves of a node that is held at rest is no motion.
      if (std::abs(term[e.index]) <= kSumRounding * std::abs(factor * e.coeff * more)) term[e.index] = 0.0;
    }
  };
  for (Eigen::Index j = 0; j < m; ++j) {
    Contact& c = contacts_[stuck_[static_cast<std::size_t>(j)]];
    if (c.loss < 0 || contacts_[idx(c.loss)].stuck) {
      hold_by(c, torque[j]);
      continue;
    }
    Contact& loss = contacts_[idx(c.loss)];
    hold_by(c, loss.unit_tie * torque[j]);
    if (loss.unit_loss != 0.0) hold_by(loss, loss.unit_loss * torque[j]);
  }
  return kWholeTerm;
}

void FrictionSeries::note_left_out(const TaylorSeries& series, int k, double factor,
                                   std::array<double, 2>& most) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    if (c.open || c.stuck || c.tied || c.tie >= 0) continue;
    const double slope = sliding_line(law(i), c.segment).slope;
    double left = 0.0;
    for (std::size_t j = 1; j < c.capacity.size() && slope != 0.0; ++j) {
      if (c.capacity[j] == 0.0) continue;
      for (std::size_t d = idx(std::max(0, k - 1 - static_cast<int>(j))); d < idx(k); ++d)
        left += std::abs(slope * c.capacity[j] * slip_term(c, series, d));
    }
    for (const Entry& e : c.gain) {
      double& largest = most[idx(series.kind(e.index))];
      largest = std::max(largest, std::abs(factor * e.coeff * left));
    }
  }
}

double FrictionSeries::carried() const {
  double largest = 0.0;
  for (const Contact& c : contacts_) largest = std::max(largest, std::abs(c.torque[0]));
  return largest;
}

void FrictionSeries::hold(const Assembler& assembler, Vector& v) const {
  if (stuck_.empty()) return;
  const auto m = static_cast<Eigen::Index>(stuck_.size());
  Vector slip(m);
  for (Eigen::Index j = 0; j < m; ++j)
    slip[j] = slip_of(contacts_[stuck_[static_cast<std::size_t>(j)]], assembler, v);
  const Vector impulse = stuck_inverse_ * slip;
  for (Eigen::Index j = 0; j < m; ++j)
    for (const Entry& e : contacts_[stuck_[static_cast<std::size_t>(j)]].gain)
      v[e.index] -= e.coeff * impulse[j];
}

double FrictionSeries::energy_of_rounding(double duration) const {
  // The whole force, accelerating by its rounding; torques that hold each other at rest are forces, too.
  const auto holds = [](const Contact& c) { return (c.stuck || c.tied) && !c.rigid; };
  double sum = 0.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double rounding = contacts_[i].speed_rounding;
    for (std::size_t j = 0; j < contacts_.size() && holds(contacts_[i]); ++j)
      if (holds(contacts_[j]))
        rounding += kSumRounding * std::abs(w_(row, static_cast<Eigen::Index>(j)) * contacts_[j].torque[0]);
    const double speed = rounding * duration;
    sum += speed * speed / (kSumRounding * w_(row, row));
  }
  return sum;
}

void FrictionSeries::add_forces(const Vector& history, Vector& f) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    for (const Entry& e : contacts_[i].z)
      f[e.index] += e.coeff * history[system_.frictions()[i].history_begin + FrictionHistory::kTorque];
}

}  // namespace drev
