// The third part of FrictionSeries: gears with losses.
#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/dense/factorization.hpp"
#include "solvers/contact/friction_complementarity.hpp"
#include "solvers/exact/friction_series.hpp"
#include "solvers/run/run_verdict.hpp"

namespace drev {

namespace {

// What the other ties leave of a tie that closes a loop, relative to W_ii.
constexpr double kClosesLoop = 1e-10;
constexpr double kFits = 1e-9;  // relative error with which the speeds at the start fit the ties
// A torque stands on its bound, relative to the torques that the bound is summed from.
constexpr double kOnGearBound = 1e-11;
constexpr double kSameBound = 1e-9;  // two lines meet, relative to the torques that the bound is summed from

/// Coefficient d of the product of two series.
double product_at(const std::vector<double>& a, const std::vector<double>& b, std::size_t d,
                  std::size_t first = 0) {
  double sum = 0.0;
  for (std::size_t j = first; j <= d && j < a.size(); ++j)
    if (d - j < b.size()) sum += a[j] * b[d - j];
  return sum;
}

}  // namespace

void FrictionSeries::find_gears() {
  std::vector<std::size_t> ties;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& c = contacts_[i];
    c.rigid = law(i).rigid();
    if (c.rigid) {
      c.stuck = true;
      c.nominal = 0.0;
      const auto row = static_cast<Eigen::Index>(i);
      const std::vector<Eigen::Index> before(ties.begin(), ties.end());
      double left = w_(row, row);
      if (!before.empty()) {
        const Vector column = w_(before, row);
        left -= column.dot(ldlt_solve(w_(before, before), column));
      }
      if (!(left > kClosesLoop * w_(row, row)))
        throw SolverError(
            system_.name() + ": " +
            system_.element_instances()[idx(index(element(static_cast<int>(i))))].name +
            " closes a loop of gears, whose torques rigid bodies do not determine; put a shaft between");
      ties.push_back(i);
    }
    if (law(i).gear_loss() == nullptr) continue;
    gears_ = true;
    c.tie = tie_of(system_, static_cast<int>(i));
    contacts_[idx(c.tie)].loss = static_cast<int>(i);
    c.efficiency.assign(TaylorSeries::kMaxDegree + 1, 0.0);
    c.bearing = c.efficiency;
  }
  begin_stuck();
  factor_stuck();
}

void FrictionSeries::check_ties(const Assembler& assembler, const Vector& v) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    if (!c.rigid) continue;
    double size = 0.0;
    for (const Entry& e : c.z) size += std::abs(e.coeff * v[e.index]);
    if (std::abs(slip_of(c, assembler, v)) <= kFits * size) continue;
    throw SolverError(at_time(system_.name(), assembler.time()) + "the speeds of " +
                      system_.element_instances()[idx(index(element(static_cast<int>(i))))].name +
                      " do not fit its ratio");
  }
}

FrictionSeries::LossValues FrictionSeries::loss_values(const Contact& c, const GearLoss& loss,
                                                       int line) const {
  const auto on_segment = [&](const std::vector<double>& values) {
    const auto k = idx(c.segment);
    if (k + 1 >= values.size()) return LossLine{values[k], 0.0};
    const double slope = (values[k + 1] - values[k]) / (loss.speeds[k + 1] - loss.speeds[k]);
    return LossLine{values[k] - slope * loss.speeds[k], slope};
  };
  return line == 0 ? LossValues{on_segment(loss.forward), on_segment(loss.bearing_forward)}
                   : LossValues{on_segment(loss.backward), on_segment(loss.bearing_backward)};
}

FrictionSolution FrictionSeries::solve_at(double t, const BoxComplementarity& problem,
                                          const std::vector<GearLossRow>& gears,
                                          const std::vector<std::size_t>& of) const {
  try {
    return solve(problem, gears);
  } catch (const SolverError& error) {
    std::string names;
    for (const GearLossRow& g : gears)
      names += (names.empty() ? "" : ", ") +
               system_
                   .element_instances()[idx(
                       index(element(static_cast<int>(of[static_cast<std::size_t>(g.loss)]))))]
                   .name;
    throw SolverError(at_time(system_.name(), t) + (names.empty() ? "" : names + ": ") + error.what());
  }
}

GearLossRow FrictionSeries::gear_at(std::size_t i, double speed, bool at_rest) const {
  const Contact& c = contacts_[i];
  GearLossRow row{.loss = static_cast<Eigen::Index>(i), .tie = c.tie};
  row.turns = at_rest ? 0 : c.sign;
  const auto lines = [&](int sign) {
    std::vector<GearLossRow::Line> found;
    for (const int line : {0, 1}) {
      const LossValues v = loss_values(c, *law(i).gear_loss(), line);
      const double efficiency = v.efficiency.at_zero + v.efficiency.slope * std::abs(speed),
                   bearing = v.bearing.at_zero + v.bearing.slope * std::abs(speed);
      if (line == 0)
        found.push_back({(1.0 - efficiency) / efficiency, sign * bearing / efficiency, line});
      else
        found.push_back({efficiency - 1.0, sign * efficiency * bearing, line});
    }
    return found;
  };
  if (row.turns >= 0) row.high = lines(1);
  if (row.turns <= 0) row.low = lines(-1);
  return row;
}

bool FrictionSeries::zero_before(const Bound& bound, int order) {
  return std::all_of(bound.g.begin(), bound.g.begin() + order, [](double x) { return x == 0.0; });
}

/// The same of the derivative of that order: only lines that meet in all lower ones count.
GearLossRow FrictionSeries::gear_derivative(std::size_t i, const Change& change, int order) const {
  using What = Change::What;
  const Contact& c = contacts_[i];
  const Contact& tie = contacts_[idx(c.tie)];
  const auto level = idx(order);
  const double loss_torque = c.torque[level], tie_torque = tie.torque[level];
  const double speed = std::abs(c.stuck || c.tied ? 0.0 : c.slip[0]);
  GearLossRow row{.loss = static_cast<Eigen::Index>(i), .tie = c.tie};
  // gap: the bound's coefficient, in the form that loss_gap() has.
  const auto add = [&](int line, int sign, double gap) {
    const LossValues v = loss_values(c, *law(i).gear_loss(), line);
    const double efficiency = v.efficiency.at_zero + v.efficiency.slope * speed;
    GearLossRow::Line found{.number = line};
    if (line == 0) {
      found.slope = (1.0 - efficiency) / efficiency;
      found.constant = (efficiency * loss_torque - (1.0 - efficiency) * tie_torque - sign * gap) / efficiency;
    } else {
      found.slope = efficiency - 1.0;
      found.constant = loss_torque + (1.0 - efficiency) * tie_torque - sign * gap;
    }
    (sign > 0 ? row.high : row.low).push_back(found);
  };
  // Those of its lines that meet the torque. A bound is as far off as the farther of its two lines: without bearing torques
  // a line of the one may meet the torque together with a line of the other, which is far.
  const auto add_bound = [&](std::span<const Bound> lines) {
    for (const Bound& b : lines) {
      const auto end = b.g.begin() + order;
      const auto first = std::find_if(b.g.begin(), end, [](double x) { return x != 0.0; });
      if (first != end && *first > 0.0) return;
    }
    for (const Bound& b : lines)
      if (zero_before(b, order)) add(b.line, b.what == What::bound_high ? 1 : -1, -b.g[level]);
  };
  if (c.stuck) {
    const std::span<const Bound> bounds = c.bounds;  // as find_gear_bounds() lists them
    add_bound(bounds.first(2));
    add_bound(bounds.last(2));
    return row;
  }
  const bool chosen = static_cast<int>(i) == change.contact && change.what == What::slip_ends;
  const bool rests = c.tied || chosen || std::any_of(c.bounds.begin(), c.bounds.end(), [&](const Bound& b) {
                       return b.what == What::slip_ends && zero_before(b, order + 1);
                     });
  row.turns = rests ? 0 : c.sign;
  add(c.line, c.sign, 0.0);
  for (const Bound& b : c.bounds)
    if (b.what == What::drive_turns && zero_before(b, order)) add(b.line, c.sign, b.g[level]);
  // Where the gear carries nothing its bounds meet.
  if (rests) add_bound(gear_bound(i, c.sign > 0 ? What::bound_low : What::bound_high));
  return row;
}

/// What is known of a gear's torques at this degree, and their direction.
void FrictionSeries::add_gear(const TaylorSeries& series, std::size_t i, int k, double factor, double* term) {
  Contact& c = contacts_[i];
  Contact& tie = contacts_[idx(c.tie)];
  const auto d = idx(k - 2);
  const LossValues v = loss_values(c, *law(i).gear_loss(), c.line);
  const double sign = c.sign;
  for (std::vector<double>* of : {&c.efficiency, &c.bearing})
    if (d >= of->size()) of->resize(d + 1);
  c.efficiency[d] = d == 0 ? v.efficiency.at_zero : 0.0;
  c.bearing[d] = d == 0 ? v.bearing.at_zero : 0.0;
  if ((v.efficiency.slope != 0.0 || v.bearing.slope != 0.0) && !c.tied) {
    double slip = d < 2 ? c.known[d] : 0.0;
    for (const Entry& e : c.z) slip += (k - 1) / h_ * e.coeff * series.coefficients(k - 1)[e.index];
    c.slip[d] = slip;
    c.efficiency[d] += sign * v.efficiency.slope * slip;
    c.bearing[d] += sign * v.bearing.slope * slip;
  }
  const double efficiency = c.efficiency[0];
  double products = 0.0;  // sum of the products of lower degrees
  if (c.line == 0) {
    for (std::size_t j = 1; j <= d; ++j) products += c.efficiency[j] * (tie.torque[d - j] + c.torque[d - j]);
    c.unit_tie = efficiency;
    c.unit_loss = 1.0 - efficiency;
    c.rest_tie = products - sign * c.bearing[d];
    c.rest_loss = -c.rest_tie;
  } else {
    for (std::size_t j = 1; j <= d; ++j)
      products += c.efficiency[j] * (tie.torque[d - j] + sign * c.bearing[d - j]);
    c.unit_tie = 1.0;
    c.unit_loss = efficiency - 1.0;
    c.rest_tie = 0.0;
    c.rest_loss = products + efficiency * sign * c.bearing[d];
  }
  tie.torque[d] = c.rest_tie;
  c.torque[d] = c.rest_loss;
  for (const Contact* of : {&tie, &c})
    if (of->torque[d] != 0.0)
      for (const Entry& e : of->gain) term[e.index] -= factor * e.coeff * of->torque[d];
}

void FrictionSeries::factor_series() {
  const auto m = static_cast<Eigen::Index>(stuck_.size());
  Eigen::MatrixXd w(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const std::size_t of = stuck_[static_cast<std::size_t>(j)];
    const int loss = contacts_[of].loss;
    const bool line = loss >= 0 && on_line(contacts_[idx(loss)]);
    for (Eigen::Index r = 0; r < m; ++r) {
      const auto row = static_cast<Eigen::Index>(stuck_[static_cast<std::size_t>(r)]);
      w(r, j) = w_(row, static_cast<Eigen::Index>(of));
      if (line)
        w(r, j) = contacts_[idx(loss)].unit_tie * w(r, j) + contacts_[idx(loss)].unit_loss * w_(row, loss);
    }
  }
  series_inverse_ = lu_solve(w, Eigen::MatrixXd(Eigen::MatrixXd::Identity(w.rows(), w.cols())));
}

/// How far the loss torque is beyond a line against the direction `sign`:
///   shaft 1 drives   sign (eta_f tau_1 - P) - tau_f,      shaft 2 drives   sign (tau_1 - eta_b P) - eta_b tau_b
std::vector<double> FrictionSeries::loss_gap(const Contact& c, const GearLoss& loss, int line, int sign,
                                             std::vector<double>& size) const {
  const Contact& tie = contacts_[idx(c.tie)];
  const LossValues v = loss_values(c, loss, line);
  const std::size_t terms = std::max<std::size_t>(2, c.torque.size());
  std::vector<double> efficiency(terms, 0.0), bearing(terms, 0.0), factor(terms, 0.0), gap(terms, 0.0);
  const bool turns = !c.stuck && !c.tied;
  for (std::size_t d = 0; d < terms; ++d) {
    const double slip = turns && d < c.slip.size() ? c.slip[d] : 0.0;
    efficiency[d] = (d == 0 ? v.efficiency.at_zero : 0.0) + sign * v.efficiency.slope * slip;
    bearing[d] = (d == 0 ? v.bearing.at_zero : 0.0) + sign * v.bearing.slope * slip;
  }
  size.assign(terms, 0.0);
  for (std::size_t d = 0; d < c.torque.size(); ++d) {
    const double out = sign * tie.torque[d], in = sign * (tie.torque[d] + c.torque[d]);
    gap[d] = line == 0 ? -out - bearing[d] : in;
    factor[d] = line == 0 ? in : -(out + bearing[d]);
    size[d] = std::abs(tie.torque[d]) + std::abs(c.torque[d]) + std::abs(bearing[d]);
  }
  for (std::size_t d = 0; d < c.torque.size(); ++d) {
    gap[d] += product_at(efficiency, factor, d);
    if (d > 0) size[d] = std::max(size[d], largest_[d]);
  }
  return gap;
}

void FrictionSeries::find_gear_bounds(std::size_t i) {
  using What = Change::What;
  Contact& c = contacts_[i];
  if (!c.stuck) {
    const int other = 1 - c.line;
    std::vector<double> size;
    c.bounds.push_back({.what = What::drive_turns,
                        .g = loss_gap(c, *law(i).gear_loss(), other, c.sign, size),
                        .line = other});
    clean(c.bounds.back(), size, kOnGearBound * size[0] + gear_rounding(c), gear_slack(c), c.line_root,
          bounded_patience());
    return;
  }
  for (const What what : {What::bound_high, What::bound_low})
    for (Bound& b : gear_bound(i, what)) c.bounds.push_back(std::move(b));
}

/// The two lines of a bound of a gear at rest.
std::array<FrictionSeries::Bound, 2> FrictionSeries::gear_bound(std::size_t i, Change::What what) const {
  const Contact& c = contacts_[i];
  const double slack = gear_slack(c);
  const int sign = what == Change::What::bound_high ? 1 : -1;
  const bool root = c.root && c.root_bound == sign;
  std::array<Bound, 2> both;
  std::vector<double> sizes[2];
  for (const int line : {0, 1}) {
    both[line] = {.what = what, .g = loss_gap(c, *law(i).gear_loss(), line, sign, sizes[line]), .line = line};
    for (double& x : both[line].g) x = -x;
  }
  const double nearest = std::max(both[0].g[0], both[1].g[0]);
  for (const int line : {0, 1}) {
    const bool on_it = root && both[line].g[0] >= nearest - kSameBound * sizes[line][0];
    clean(both[line], sizes[line], kOnGearBound * sizes[line][0] + gear_rounding(c), slack, on_it,
          bounded_patience());
  }
  return both;
}

double FrictionSeries::gear_slack(const Contact& c) const {
  const bool at_root = c.root || c.line_root || resolved_;
  return at_root ? c.torque_slack + contacts_[idx(c.tie)].torque_slack : 0.0;
}

double FrictionSeries::gear_rounding(const Contact& c) const {
  return c.torque_rounding + contacts_[idx(c.tie)].torque_rounding + gear_slack(c);
}

void FrictionSeries::note_gear(std::size_t i, double speed, Vector& history) const {
  const Contact& c = contacts_[i];
  const FrictionTerm &tie = system_.frictions()[idx(c.tie)], &loss = system_.frictions()[i];
  const double out = history[tie.history_begin + FrictionHistory::kTorque],
               lost = history[loss.history_begin + FrictionHistory::kTorque];
  history[tie.history_begin + FrictionHistory::kState] = c.stuck || c.tied ? 0 : 1 + c.line;
  history[loss.history_begin + FrictionHistory::kTorqueIn] = out + lost;
  history[loss.history_begin + FrictionHistory::kTorqueOut] = -tie.nodes.back().coeff * out;
  history[loss.history_begin + FrictionHistory::kPower] = c.stuck || c.tied ? 0.0 : lost * speed;
}

}  // namespace drev
