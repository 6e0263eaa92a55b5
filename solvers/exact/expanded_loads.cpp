#include "solvers/exact/expanded_loads.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {

// Turn allowed for in a step, relative to the turn at the rate of the step before.
constexpr double kFurther = 1.25;
constexpr double kOfTorque = 1e-18;      // terms of P and G that are left out, relative to the torque
constexpr double kNearEdge = 0.95;       // largest part of the way to the end of a cell that a step takes
constexpr double kLoadRounding = 1e-14;  // of a torque summed up along a step, relative to its parts
constexpr double kOnes[kLanes] = {1, 1, 1, 1, 1, 1, 1, 1};

}  // namespace

/// Loops over the loads of a group; arrays hold kLanes of each degree, or of each power of x.
struct ExpandedLoads::Start {
  template <class L>
  [[gnu::always_inline]] static void shift(int terms, int top, const L& by, const double* from, L* to) {
    for (int j = 0; j < terms; ++j) load(from + j * kLanes, to[j]);
    for (int j = terms; j <= top; ++j) to[j] = L{};
    for (int j = 0; j <= top; ++j)
      for (int k = terms - 2; k >= j; --k) to[k] += by * to[k + 1];
  }
  /// P and G about the step's start, from the cells' terms and the cubics. sizes: of the largest lane,
  /// (|P_j| + |G_j| w^2) reach^j.
  template <class L>
  [[gnu::always_inline]] static void run(int top, Group* group, double* sizes) {
    const int terms = group->cell_terms;
    L by, about, f[kTerms], of_speed[kTerms], c[4], reach, square, power;
    load(group->distance.data(), by);
    shift(terms, top, by, group->factor.data(), f);
    if (group->speeds) shift(terms, top, by, group->by_speed.data(), of_speed);
    load(group->from_about.data(), about);
    for (int i = 0; i < 4; ++i) load(group->cubic.data() + i * kLanes, c[i]);
    for (int i = 0; i < 3; ++i)
      for (int k = 2; k >= i; --k) c[k] += about * c[k + 1];
    load(group->reach.data(), reach);
    load(group->speed.data(), square);
    square = square * square;
    load(kOnes, power);
    for (int j = 0; j <= top; ++j) {
      L sum = c[0] * f[j];
      for (int i = 1; i <= std::min(j, 3); ++i) sum += c[i] * f[j - i];
      store(sum, group->p.data() + j * kLanes);
      magnitude(sum);
      if (group->speeds) {
        store(of_speed[j], group->g.data() + j * kLanes);
        magnitude(of_speed[j]);
        sum += of_speed[j] * square;
      }
      sum = sum * power;
      sizes[j] = largest_of(sum);
      power = power * reach;
    }
  }
};

/// P(x)_m and, with speeds, (G(x) w^2)_m; out: what the load differs there from its tangent.
struct ExpandedLoads::Term {
  template <class L>
  [[gnu::always_inline]] static void run(int m, Group* group, double* out) {
    const double *x = group->x.data(), *p = group->p.data(), *g = group->g.data();
    const bool speeds = group->speeds;
    L a, b, now, torque, curve{};
    load(x + m * kLanes, now);
    load(p + kLanes, a);
    torque = a * now;
    if (speeds) {
      load(g + kLanes, a);
      curve = a * now;
    }
    const double* below = x;
    double* row = group->powers.data();
    for (int j = 2; j <= std::min(m, group->top); ++j) {
      L sum{};
      for (int i = 1; i <= m - j + 1; ++i) {
        load(x + i * kLanes, a);
        load(below + (m - i) * kLanes, b);
        sum += a * b;
      }
      store(sum, row + m * kLanes);
      load(p + j * kLanes, a);
      torque += a * sum;
      if (speeds) {
        load(g + j * kLanes, a);
        curve += a * sum;
      }
      below = row;
      row += kOrders * kLanes;
    }
    load(group->slope.data(), a);
    L rest = torque - a * now;
    if (speeds) {
      double *curves = group->curve.data(), *squares = group->square.data();
      const double* rates = group->rate.data();
      store(curve, curves + m * kLanes);
      L square{};
      for (int i = 0; i <= m; ++i) {
        load(rates + i * kLanes, a);
        load(rates + (m - i) * kLanes, b);
        square += a * b;
      }
      store(square, squares + m * kLanes);
      for (int i = 0; i <= m; ++i) {
        load(curves + i * kLanes, a);
        load(squares + (m - i) * kLanes, b);
        rest += a * b;
      }
      load(rates + m * kLanes, a);
      load(group->speed_slope.data(), b);
      rest = rest - a * b;
    }
    store(rest, out);
  }
};

/// out: what the torques at s = 1, where the angles' terms below s^k have led, differ from their tangents by, less the terms of that
/// below s^(k-1); size: of the parts of this difference.
struct ExpandedLoads::LeftOut {
  template <class L>
  [[gnu::always_inline]] static void run(int k, const Group* group, double* out, double* size) {
    L a, b, x{}, torque{}, terms{};
    for (int m = k - 1; m > 0; --m) {
      load(group->x.data() + m * kLanes, a);
      x += a;
    }
    for (int m = k - 2; m > 0; --m) {
      load(group->rest.data() + m * kLanes, a);
      terms += a;
    }
    for (int j = group->top; j > 0; --j) {
      load(group->p.data() + j * kLanes, a);
      torque = (torque + a) * x;
    }
    load(group->slope.data(), a);
    torque = torque - a * x;
    if (group->speeds) {
      L w{}, start{}, curve{};
      for (int m = k - 2; m >= 0; --m) {
        load(group->rate.data() + m * kLanes, start);
        w += start;
      }
      for (int j = group->top; j > 0; --j) {
        load(group->g.data() + j * kLanes, a);
        curve = (curve + a) * x;
      }
      load(group->g.data(), a);
      load(group->speed_slope.data(), b);
      torque += (curve + a) * w * w - a * start * start - b * (w - start);
    }
    store(torque - terms, out);
    magnitude(torque);
    magnitude(terms);
    store(torque + terms, size);
  }
};

/// out: int_0^s p z' du, z: the row's motion.
struct ExpandedLoads::Work {
  template <class L>
  [[gnu::always_inline]] static void run(int degree, double per_time, double s, const Group* group,
                                         const double* nodes, const double* weights, double* out) {
    L a, sum{};
    for (int q = 0; q < GaussRule::kNodes; ++q) {
      const double at = s * nodes[q];
      L x{}, rate{}, along{};
      for (int k = degree; k >= 1; --k) {
        load(group->x.data() + k * kLanes, a);
        rate = rate * at + x;
        x = x * at + a;
        load(group->along.data() + k * kLanes, a);
        along = along * at + static_cast<double>(k) * a;
      }
      rate = rate * at + x;
      x = x * at;
      L p{}, g{};
      for (int j = group->top; j >= 0; --j) {
        load(group->p.data() + j * kLanes, a);
        p = p * x + a;
        if (!group->speeds) continue;
        load(group->g.data() + j * kLanes, a);
        g = g * x + a;
      }
      if (group->speeds) {
        rate = per_time * rate;
        p += g * rate * rate;
      }
      sum += (s * weights[q]) * (p * along);
    }
    store(sum, out);
  }
};

bool ExpandedLoads::takes(const System& system, const LoadTerm& term) {
  if (dynamic_cast<const HarmonicLoad*>(term.load) != nullptr) return true;
  return dynamic_cast<const KnottedLoad*>(term.load) != nullptr &&
         system.knotted_loads().curves_of(*term.load) != nullptr;
}

bool ExpandedLoads::holds(const System& system, const LoadTerm& term, bool constant) {
  const auto* knots = dynamic_cast<const KnottedLoad*>(term.load);
  return (constant && system.ratio(term.node) != 0.0) || knots == nullptr || !knots->piece_follows_speed();
}

void ExpandedLoads::add(const LoadTerm& term, TaylorSeries& series) {
  Load load(system_, term);
  if (const auto* harmonic = dynamic_cast<const HarmonicLoad*>(term.load)) {
    load.cells = std::make_shared<HarmonicCells>(harmonic->orders());
  } else {
    load.knots = dynamic_cast<const KnottedLoad*>(term.load);
    load.curves = system_.knotted_loads().curves_of(*term.load);
  }
  Vector row = Vector::Zero(system_.size()), gain;
  if (load.row < system_.size())
    row[load.row] = load.coeff;
  else
    row = load.coeff * system_.rows().row(load.row - system_.size()).transpose();
  series.solve_mass(row, gain);
  for (int i = 0; i < system_.size(); ++i)
    if (gain[i] != 0.0) load.gain.push_back({i, gain[i]});
  load.find_reach(series);
  loads_.push_back(std::move(load));
}

void ExpandedLoads::find_groups(const MotionPoint& nominal) {
  const bool constant = is_constant(nominal);
  if (grouped_ && constant == constant_) return;
  grouped_ = true;
  constant_ = constant;
  groups_.clear();
  knotted_ = false;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    Load& load = loads_[i];
    load.acts = holds(system_, *load.term, constant);
    load.watched = false;
    load.contraction = 0.0;
    if (!load.acts) continue;
    if (groups_.empty() || groups_.back().count == kLanes) {
      groups_.emplace_back();
      groups_.back().powers.resize(kTerms * kOrders * kLanes);
    }
    Group& group = groups_.back();
    const auto lane = idx(group.count++);
    group.load[lane] = static_cast<int>(i);
    group.speeds = group.speeds || load.knots != nullptr;
    group.cell_terms = std::max(group.cell_terms, load.knots ? CurveCells::kTerms : HarmonicCells::kTerms);
    group.top = kTerms - 1;
    knotted_ = knotted_ || load.knots != nullptr;
  }
}

void ExpandedLoads::move(const Assembler& assembler, const Vector& z, const Vector& v) {
  const MotionPoint& nominal = assembler.nominal();
  find_groups(nominal);
  nominal_rate_ = nominal.rate;
  for (Load& l : loads_) {
    if (!l.acts) continue;
    l.move(system_, nominal, z, v);
    if (l.knots != nullptr) l.follow(l.angle, l.speed, l.ratio * nominal.rate);
  }
}

void ExpandedLoads::move_as(const ExpandedLoads& other) {
  loads_ = other.loads_;
  groups_ = other.groups_;
  grouped_ = other.grouped_;
  constant_ = other.constant_;
  knotted_ = other.knotted_;
  nominal_rate_ = other.nominal_rate_;
}

/// Puts the polynomials that hold about the load's angle into its lane.
void ExpandedLoads::place(Load& l, Group& group, std::size_t lane) {
  double centre = 0.0, distance = 0.0, held = 0.0;
  const auto take = [&](const void* cell, const auto& terms, auto& to) {
    if (group.cell[lane] == cell && group.centre[lane] == centre) return;
    for (std::size_t j = 0; j < terms.size(); ++j) to[j * kLanes + lane] = terms[j];
  };
  if (l.cells) {
    const HarmonicCells::Place at = l.cells->at(l.angle);
    centre = at.cell->centre;
    distance = at.distance;
    held = l.cells->reach();
    take(at.cell, at.cell->terms, group.factor);
    group.cell[lane] = at.cell;
    group.cubic[lane] = 1.0;
  } else {
    const CurveCells::Place at = l.curves->at(l.angle);
    centre = at.cell->centre;
    distance = at.distance;
    held = l.curves->reach();
    take(at.cell, at.cell->factor, group.factor);
    take(at.cell, at.cell->by_speed, group.by_speed);
    group.cell[lane] = at.cell;
    for (std::size_t k = 0; k < l.piece.terms.size(); ++k) group.cubic[k * kLanes + lane] = l.piece.terms[k];
    group.from_about[lane] = l.angle - l.about;
  }
  group.centre[lane] = centre;
  group.distance[lane] = distance;
  group.speed[lane] = l.speed;
  const double rate = std::max(std::abs(l.speed), group.came[lane]);
  group.reach[lane] = kFurther * rate * h_;
  const double room = held - std::abs(distance);
  if (group.reach[lane] > room) part_held_ = std::min(part_held_, kNearEdge * room / group.reach[lane]);
}

void ExpandedLoads::add_to(TaylorSeries& series, double h, const std::array<double, 3>& phi) {
  h_ = h;
  phi_ = phi;
  part_held_ = 1.0;
  std::array<double, kTerms> sizes;
  for (Group& group : groups_) {
    for (std::size_t lane = 0; lane < idx(group.count); ++lane)
      place(loads_[idx(group.load[lane])], group, lane);
    // A little more than mattered in the step before, or all; of a torque that is even or odd every second term is zero.
    for (int last = std::min(group.top + 3, kTerms - 1);; last = kTerms - 1) {
      last = std::min(last, group.cell_terms + 2);
      run_widest<Start>(last, &group, sizes.data());
      double sum = 0.0;
      for (int j = 0; j <= last; ++j) sum += sizes[idx(j)];
      group.top = last;
      while (group.top > 1 && sizes[idx(group.top)] <= kOfTorque * sum) --group.top;
      if (group.top < last - 1 || last == std::min(kTerms - 1, group.cell_terms + 2)) break;
    }
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      Load& l = loads_[idx(group.load[lane])];
      const double g = group.speeds ? group.g[lane] : 0.0;
      l.torque = group.p[lane] + g * l.speed * l.speed;
      l.slope = l.speed_slope = 0.0;
      if (l.feedback) {
        l.slope = group.p[kLanes + lane];
        if (group.speeds) l.slope += group.g[kLanes + lane] * l.speed * l.speed;
        if (l.row < system_.size()) l.speed_slope = 2.0 * g * l.speed;
      }
      group.slope[lane] = l.slope;
      group.speed_slope[lane] = l.speed_slope;
      l.add_to(h, phi, series.stride(), series.right_side(0));
      l.add_slopes(series, l.ratio * nominal_rate_);
    }
  }
}

/// Term m of the series of rows and angles.
void ExpandedLoads::gather(Group& group, const TaylorSeries& series, int m) const {
  const auto at = idx(m) * kLanes;
  for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
    const Load& l = loads_[idx(group.load[lane])];
    const double along = l.coeff * series.coefficient(m, l.row);
    const double x = (m < 3 ? l.ratio * phi_[idx(m)] : 0.0) + (l.feedback ? along : 0.0);
    group.along[at + lane] = along;
    group.x[at + lane] = x;
    group.rate[at - kLanes + lane] = m * x / h_;
  }
}

double ExpandedLoads::add(const TaylorSeries& series, int k, double factor, double* term) {
  const int m = k - 2;
  double most = 0.0;
  for (Group& group : groups_) {
    gather(group, series, m + 1);
    if (m == 0) {  // all of it is in the tangent
      for (std::size_t lane = 0; lane < kLanes && group.speeds; ++lane) {
        group.square[lane] = group.rate[lane] * group.rate[lane];
        group.curve[lane] = group.g[lane];
      }
      continue;
    }
    double* rest = group.rest.data() + idx(m) * kLanes;
    run_widest<Term>(m, &group, rest);
    for (std::size_t lane = 0; lane < idx(group.count); ++lane)
      for (const Entry& e : loads_[idx(group.load[lane])].gain) {
        const double added = e.coeff * rest[lane] * factor;
        term[e.index] += added;
        most = std::max(most, std::abs(added));
      }
  }
  return most;
}

void ExpandedLoads::note_left_out(const TaylorSeries& series, int k, double factor,
                                  TaylorSeries::Norm& most) const {
  OneLanes left, size;
  for (const Group& group : groups_) {
    run_widest<LeftOut>(k, &group, left.data(), size.data());
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      const Load& l = loads_[idx(group.load[lane])];
      if (!(std::abs(left[lane]) > kLoadRounding * (std::abs(l.torque) + size[lane]))) continue;
      for (const Entry& e : l.gain) {
        double& largest = most[idx(series.kind(e.index))];
        largest = std::max(largest, std::abs(factor * e.coeff * left[lane]));
      }
    }
  }
}

bool ExpandedLoads::came_further(const TaylorSeries& series) {
  bool further = false;
  for (Group& group : groups_)
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      double sum = 0.0;
      for (std::size_t k = 1; k < idx(series.degree()); ++k) sum += std::abs(group.x[k * kLanes + lane]);
      group.came[lane] = sum / h_;
      further = further || sum > group.reach[lane];
    }
  return further;
}

double ExpandedLoads::work(const TaylorSeries& series, double s) {
  const GaussRule& rule = gauss_rule();
  std::array<double, kLanes> of_lanes;
  double sum = 0.0;
  for (Group& group : groups_) {
    gather(group, series, series.degree());
    run_widest<Work>(series.degree(), 1.0 / h_, s, &group, rule.s.data(), rule.weight.data(),
                     of_lanes.data());
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) sum += of_lanes[lane];
  }
  return sum;
}

ExpandedLoads::Values ExpandedLoads::values(const double* terms, int degree, std::size_t lane, double s) {
  Values v;
  for (int k = degree; k >= 0; --k) {
    v.bend = v.bend * s + 2.0 * v.slope;
    v.slope = v.slope * s + v.value;
    v.value = v.value * s + terms[idx(k) * kLanes + lane];
  }
  return v;
}

/// The part of swept_work() of a load whose angle follows no motion, which may turn far in a step: int p y' by Gauss's nodes.
double ExpandedLoads::given_work(const Group& group, std::size_t lane, const Load& l,
                                 const TaylorSeries& series, double s) const {
  const GaussRule& rule = gauss_rule();
  NodeValues y;
  series.swept_at_nodes({{l.row, l.coeff}}, s, y);
  double sum = 0.0;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    const Values x = values(group.x.data(), 2, lane, s * rule.s[q]);
    double torque = values(group.p.data(), group.top, lane, x.value).value;
    if (group.speeds)
      torque += values(group.g.data(), group.top, lane, x.value).value * (x.slope / h_) * (x.slope / h_);
    sum += s * rule.weight[q] * torque * y.slope[q];
  }
  return sum;
}

double ExpandedLoads::swept_work(const TaylorSeries& series, double s) const {
  const double *y = series.swept(0), *y_sum = series.swept(1), *y_sum_2 = series.swept(2);
  double sum = 0.0;
  for (const Group& group : groups_)
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      const Load& l = loads_[idx(group.load[lane])];
      if (!l.feedback) {
        sum += given_work(group, lane, l, series, s);
        continue;
      }
      const Values x = values(group.x.data(), series.degree(), lane, s);
      const Values along = values(group.along.data(), series.degree(), lane, s);
      const Values p = values(group.p.data(), group.top, lane, x.value);
      const Values g = group.speeds ? values(group.g.data(), group.top, lane, x.value) : Values{};
      const double w = x.slope / h_;
      const double torque = p.value + g.value * w * w, slope = p.slope + g.slope * w * w,
                   by_speed = 2.0 * g.value * w / h_;
      const double rate = slope * x.slope + by_speed * x.bend,
                   rate_2 = p.bend * x.slope * x.slope + p.slope * x.bend;
      const auto row = idx(l.row);
      // int p y' by parts; and what y changes of p, on z' and y'.
      const double y_s = l.coeff * y[row], sum_1 = l.coeff * y_sum[row], sum_2 = l.coeff * y_sum_2[row];
      sum += torque * y_s - rate * sum_1 + rate_2 * sum_2;
      sum += slope * (along.slope * sum_1 - along.bend * sum_2 + 0.5 * y_s * y_s);
      sum += by_speed * (along.slope * y_s - along.bend * sum_1);
    }
  return sum;
}

}  // namespace drev
