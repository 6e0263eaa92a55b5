#include "solvers/exact/load_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/contact/roots.hpp"
#include "solvers/linear/vector_kernels.hpp"

namespace drev {

namespace {

// Rounding of the distance to a knot, relative to the largest term of an angle's series.
constexpr double kAtKnot = 1e-13;
// Least term that tells which way an angle leaves a knot, relative to the largest: it comes over the knot by its square at most, and
// what is projected is off by more than rounding at the step's start.
constexpr double kLeastLead = 1e-5;
// Error of the path inside a step, relative to the rest that the projection leaves: 1/(4 D^2).
constexpr double kPathRest = 4e-3;
// Error of the step's end, relative to the same: (2 D + 3) j_{D+1}(3/2), see legendre_projection.hpp.
constexpr double kEndRest = 1e-6;
// Coefficients that tell the rest of kinks.
constexpr int kTail = 4;
// Error of the step's end, relative to what nodes do not see of a force: half a distance between two of them, of a jump.
constexpr double kNodeRest = 0.1;
// A smooth force is off its projection by no more than so much of the last coefficients at the step's ends.
constexpr double kSmoothEnds = 2.0;
// Error of the step's end behind a kink, relative to the rest times its contraction factor: the rest swings about zero there.
constexpr double kKinkRest = 1e-5;
// Rounding of the projection's coefficients, relative to the largest force so far.
constexpr double kForceRounding = 4e-15;
// What a projection leaves is rounding where it is below kMostRounding of the force and a step of at most kMuchShorter the length
// leaves at least kSameRest of it. A smooth force would leave far less, and a jump below kMostRounding moves next to nothing. That of a
// force that follows the motion is known from its slopes, and a kink that comes and goes with the motion leaves as much, too.
constexpr double kMostRounding = 1e-7, kMostOfMoved = 1e-10, kMuchShorter = 0.3, kSameRest = 0.5;
constexpr double kRoundingVaries = 16.0;  // from step to step, at most

std::array<double, 3> over_step(const MotionPoint& m, double h) {
  return {m.value, m.rate * h, 0.5 * m.acceleration * h * h};
}

}  // namespace

LoadSeries::LoadSeries(const System& system, TaylorSeries& series)
    : system_(system),
      assembler_(system),
      straight_(system),
      expanded_(system),
      smooth_(system),
      stride_(TaylorSeries::stride(system)),
      p_(idx(kProjectionTerms * stride_)),
      base_(idx(3 * stride_)),
      projection_(stride_),
      last_(stride_),
      of_loads_(stride_),
      of_kinks_(stride_),
      largest_force_(idx(stride_)),
      changes_(idx(stride_)),
      rounding_(idx(stride_)),
      too_large_(idx(stride_)),
      last_kink_(idx(stride_)),
      u_(idx(system.prescribed_count())) {
  for (const LoadTerm& term : system.loads()) {
    const NodeMap& map = system.node_map(term.node);
    if (map.prescribed >= 0) {  // its work is the prescribed node's
      if (term.load->stretch(0.0, 0.0, 1.0)) on_prescribed_.push_back(&term);
      continue;
    }
    if (term.load->stretch(0.0, 0.0, 1.0)) {
      straight_.add(term, series);
      continue;
    }
    const bool expanded = ExpandedLoads::takes(system, term);
    if (expanded) expanded_.add(term, series);
    if (!expanded || !ExpandedLoads::holds(system, term, false)) smooth_.add(term, expanded);
  }
}

void LoadSeries::move(double t, const Vector& z, const Vector& v) {
  t_ = t;
  tried_ = 0.0;
  assembler_.set_time(t);
  straight_.move(assembler_.nominal(), z, v);
  expanded_.move(assembler_, z, v);
  smooth_.move(assembler_, z, v);
}

void LoadSeries::locate(double t, const Vector& z, const Vector& v) {
  move(t, z, v);
  straight_.locate(t);
}

void LoadSeries::locate_as(const LoadSeries& other) {
  of_part_ = true;
  t_ = other.t_;
  assembler_.set_time(t_);
  straight_.move_as(other.straight_);
  expanded_.move_as(other.expanded_);
  smooth_.move_as(other.smooth_);
}

void LoadSeries::advance(double t, const Vector& z, const Vector& v, bool whole) {
  move(t, z, v);
  straight_.advance(t, whole);
}

void LoadSeries::pass_knot() {
  tried_ = 0.0;
  for (StraightLoads::Load& l : straight_.loads())
    if (&l == leaving_) straight_.look_up(l, t_, leaving_direction_);
  for (ExpandedLoads::Load& l : expanded_.loads())
    if (&l == leaving_) expanded_.look_up(l, leaving_direction_);
}

void LoadSeries::add_to(TaylorSeries& series, double h) {
  const int n = system_.size();
  h_ = h;
  degree_ = 2;
  projected_ = false;
  std::fill_n(p_.begin(), 3 * stride_, 0.0);
  const auto p = [&](int k, int row) -> double& { return p_[idx(k * stride_ + row)]; };
  const auto add = [&](int k, double factor, const Vector& values) {
    add_multiple(n, factor, values.data(), &p(k, 0));
  };
  const MotionPoint& nominal = assembler_.nominal();
  phi_ = over_step(nominal, h);
  if (nominal.acceleration != 0.0) add(0, -nominal.acceleration, system_.nominal_inertia());
  if (nominal.rate != 0.0) add(0, -nominal.rate, system_.nominal_drag());
  if (nominal.acceleration != 0.0) add(1, -nominal.acceleration * h, system_.nominal_drag());
  if (system_.any_prescribed_moves()) {
    const MatrixSet& zu = system_.coupling_zu();
    for (int k = 0; k < system_.prescribed_count(); ++k) {
      const MotionPoint& u = assembler_.prescribed(k);
      u_[idx(k)] = over_step(u, h);
      for (SparseMatrix::InnerIterator it(zu.mass, k); it; ++it)
        p(0, static_cast<int>(it.row())) -= it.value() * u.acceleration;
      for (SparseMatrix::InnerIterator it(zu.damping, k); it; ++it) {
        p(0, static_cast<int>(it.row())) -= it.value() * u.rate;
        p(1, static_cast<int>(it.row())) -= it.value() * u.acceleration * h;
      }
      for (SparseMatrix::InnerIterator it(zu.stiffness, k); it; ++it)
        for (int i = 0; i < 3; ++i) p(i, static_cast<int>(it.row())) -= it.value() * u_[idx(k)][idx(i)];
    }
  }
  straight_.add_to(series, t_, h, phi_, p_.data());
  smooth_.add_to(h, phi_, p_.data());
  add_multiple(3 * stride_, 1.0, p_.data(), series.right_side(0));
  smooth_.add_slopes(series);
  expanded_.add_to(series, h, phi_);
}

double LoadSeries::angle_term(const PlacedLoad& l, const TaylorSeries& series, int k) const {
  const double nominal = k < 3 ? l.ratio * phi_[idx(k)] : 0.0;
  return l.feedback ? nominal + l.coeff * series.coefficient(k, l.row) : nominal;
}

/// Of the last coefficients of a force, the larger of two in a row, of which a force that is even or odd has one: (D, D-1), (D-2, D-3).
static std::array<double, 2> last_of(const LegendreProjection& forces, int row) {
  const auto larger = [&](int j) {
    return std::max(std::abs(forces.coefficient(j, row)), std::abs(forces.coefficient(j - 1, row)));
  };
  return {larger(kProjectionDegree), larger(kProjectionDegree - 2)};
}

/// What no polynomial of the projection's degree holds of a smooth force: coefficients fall from degree to degree at an even rate,
/// and the next one tells. Those at twice the nodes' count tell what Gauss's rule leaves of the coefficients themselves; and what
/// changes beside the step's ends, where no node is, shows there.
LoadSeries::Rest LoadSeries::rest_of_force(int row, double off_at_ends) const {
  const auto [last, before] = last_of(projection_, row);
  const double falls = last > 0.0 ? std::min(1.0, last / before) : 0.0, falls_2 = falls * falls;
  Rest rest{.smooth = last * falls,
            .rough = std::max(last * falls_2 * falls_2, off_at_ends - kSmoothEnds * last)};
  const double rounding = rounding_[idx(row)];
  if (rest.smooth <= rounding) rest.smooth = 0.0;
  if (rest.rough <= rounding) rest.rough = 0.0;
  return rest;
}

double LoadSeries::size_of_force(int row) const {
  double size = 0.0;
  for (int k = 0; k < 3; ++k) size += std::abs(p_[idx(k * stride_ + row)]);
  for (int j = 0; j < kProjectionTerms; ++j) size += std::abs(projection_.coefficient(j, row));
  return size;
}

std::optional<double> LoadSeries::find_rounding(const ProjectedLaws& laws) {
  // The rest is that of all forces on a row: one that follows the motion may be its cause.
  row_rest_.assign(idx(stride_), {});
  const auto note = [&](int row, double off_at_ends, bool follows) {
    RowRest& all = row_rest_[idx(row)];
    const auto [smooth, rough] = rest_of_force(row, off_at_ends);
    all.tail = std::max({all.tail, smooth, rough});
    all.follows = all.follows || follows;
    all.acts = true;
  };
  smooth_.for_rows(note);
  laws.for_rows(note);
  std::optional<double> found;
  for (int row = 0; row < stride_; ++row) {
    const auto [tail, follows, acts] = row_rest_[idx(row)];
    if (!acts) continue;
    double& before = too_large_[idx(row)];
    if (tried_ > 0.0 && h_ <= kMuchShorter * tried_ && tail > rounding_[idx(row)] &&
        tail >= kSameRest * before && tail <= (follows ? kMostOfMoved : kMostRounding) * size_of_force(row)) {
      rounding_[idx(row)] = kRoundingVaries * tail;
      found = tried_;
    }
    before = tail;
  }
  tried_ = h_;
  return found;
}

/// Of the motion, by a force on a row. Where friction leaves no motion but rounding, the forces themselves are the measure.
double LoadSeries::measured(const TaylorSeries& series, int row, double force, bool held) const {
  const double by = force > 0.0 ? force * relative_move(series, row) : 0.0,
               largest = largest_force_[idx(row)];
  if (held && largest > 0.0 && !(by <= force / largest)) return force / largest;
  return std::isfinite(by) ? by : 0.0;
}

double LoadSeries::unseen_of(const TaylorSeries& series, int row, double rough, bool held) const {
  // A train at rest, which is moved between the nodes alone.
  if (rough > 0.0 && !std::isfinite(relative_move(series, row)) && size_of_force(row) == 0.0)
    return std::numeric_limits<double>::infinity();
  return kNodeRest * measured(series, row, rough, held);
}

double LoadSeries::unseen_between(const TaylorSeries& series, ProjectedLaws& laws, bool held, double most) {
  // A force that does more moves more than may be left unseen; where nothing has moved yet, any.
  smooth_.look_between(series, [&](int row) { return most / (kNodeRest * relative_move(series, row)); });
  if (!laws.empty()) laws.look_between(series);
  double unseen = 0.0;
  const auto note = [&](int row, double off, bool) {
    unseen = std::max(unseen, unseen_of(series, row, rest_of_force(row, off).rough, held));
  };
  smooth_.for_rows(note);
  laws.for_rows(note);
  return unseen;
}

LoadSeries::Pass LoadSeries::project(TaylorSeries& series, ProjectedLaws& laws, bool first, bool held,
                                     double carried) {
  if (first) {
    for (int k = 0; k < 3; ++k) std::copy_n(series.right_side(k), stride_, base_.data() + k * stride_);
    last_.clear();
  } else {
    std::swap(last_, projection_);
  }
  projection_.clear();
  const auto [z_scale, v_scale] = smooth_.follow(series);
  for (std::size_t kind = 0; kind < per_reach_.size(); ++kind)
    per_reach_[kind] = h_ / std::min(z_scale[kind] / (0.5 * h_), v_scale[kind]);
  Pass pass;
  pass.follows = smooth_.follows();
  pass.contraction = find_kinks(series);
  pass.contraction = std::max(pass.contraction, smooth_.project(series, first, projection_, of_kinks_));
  if (!laws.empty()) {
    of_loads_ = projection_;
    if (kinked()) of_loads_ += of_kinks_;
    pass.contraction = std::max(pass.contraction, laws.project(series, projection_));
  }
  const auto note_rounding = [&](int row, double rounding) {
    rounding_[idx(row)] = std::max(rounding_[idx(row)], rounding);
  };
  smooth_.for_rounding(note_rounding);
  laws.for_rounding(note_rounding);
  // Kinks apart: no polynomial of any degree holds them, and at the step's end they need none.
  const auto rest_of_kinks = [&](int row) {
    double tail = 0.0;
    for (int j = kProjectionDegree - kTail + 1; j <= kProjectionDegree; ++j)
      tail += std::abs(of_kinks_.coefficient(j, row));
    return measured(series, row, tail, false);
  };
  if (held) {
    const auto note = [&](int row, double, bool) {
      largest_force_[idx(row)] = std::max(largest_force_[idx(row)], size_of_force(row));
    };
    smooth_.for_rows(note);
    laws.for_rows(note);
  }
  // The path is off inside the step; of that, the contraction factor comes back at its end.
  const double at_end = std::max(kEndRest, kPathRest * pass.contraction);
  const auto note_rest = [&](int row, double off_at_ends, bool) {
    const Rest rest = rest_of_force(row, off_at_ends);
    const double largest = largest_force_[idx(row)], lacks = std::max(rest.smooth, rest.rough);
    // A train at rest turns by the rounding of what friction carries, and what follows this is rounding, too.
    if (held && lacks > kForceRounding * std::max(largest, carried))
      pass.torque = std::max(pass.torque, lacks / largest);
    const double smooth = measured(series, row, rest.smooth, held);
    pass.inside = std::max(pass.inside, kPathRest * smooth);
    pass.residual = std::max(pass.residual, at_end * smooth);
    pass.unseen = std::max(pass.unseen, unseen_of(series, row, rest.rough, held));
  };
  smooth_.for_rows(note_rest);
  laws.for_rows(note_rest);
  if (kinked()) {
    // A kink is projected along a path that lacks the rest itself.
    for_knotted([&](const PlacedLoad& l, double, double) {
      if (l.contraction > 0.0)
        pass.residual = std::max(pass.residual, kKinkRest * l.contraction * rest_of_kinks(l.row));
    });
    smooth_.for_kinked([&](int row, double contraction, double strongest, bool must) {
      const double rest = rest_of_kinks(row);
      pass.residual = std::max(pass.residual, kKinkRest * contraction * rest);
      if (must || (kPathRest * rest > kMostInside && strongest < 1.0))
        pass.cut = std::min(pass.cut.value_or(1.0), strongest);
    });
    projection_ += of_kinks_;
  }
  projection_.difference(last_, changes_.data());
  const auto note_change = [&](int row) {
    const double size = changes_[idx(row)];
    if (!(size > 0.0)) return;
    const double moves = size * relative_move(series, row), force = largest_force_[idx(row)];
    pass.change = std::max(pass.change, held && force > 0.0 ? std::min(moves, size / force) : moves);
  };
  for_knotted([&](const PlacedLoad& l, double, double) { note_change(l.row); });
  smooth_.for_rows([&](int row, double, bool) { note_change(row); });
  laws.for_rows([&](int row, double, bool) { note_change(row); });
  if (pass.change == 0.0) return pass;
  projected_ = true;
  with_laws_ = !laws.empty();
  degree_ = kProjectionDegree;
  for (int k = 0; k < 3; ++k) std::copy_n(base_.data() + k * stride_, stride_, series.right_side(k));
  projection_.add_powers(3, series.right_side(0));
  series.set_right_degree(kProjectionDegree);
  return pass;
}

void LoadSeries::shorten(double r) {
  double power = 1.0;
  for (int k = 0; k < 3; ++k, power *= r) {
    for (int i = 0; i < stride_; ++i) p_[idx(k * stride_ + i)] *= power;
    phi_[idx(k)] *= power;
    for (auto& u : u_) u[idx(k)] *= power;
  }
}

std::optional<double> LoadSeries::first_knot(const TaylorSeries& series, double end) {
  leaving_ = nullptr;
  std::optional<double> first;
  const auto degree = static_cast<std::size_t>(series.degree());
  for_knotted([&](const PlacedLoad& l, double low, double high) {
    if (!l.watched) return;
    for (const double side : {1.0, -1.0}) {
      const double bound = side > 0.0 ? high : low;
      if (std::isinf(bound)) continue;
      std::vector<double>& g = power_;
      g.assign(1, std::max(0.0, side * (bound - l.angle)));
      for (std::size_t k = 1; k <= degree; ++k)
        g.push_back(-side * angle_term(l, series, static_cast<int>(k)));
      // On the knot itself, as at rest, the first term that counts tells which way the angle goes.
      double largest = 0.0;
      for (const double term : g) largest = std::max(largest, std::abs(term));
      std::size_t lead = 0;
      while (lead <= degree && std::abs(g[lead]) <= (lead == 0 ? kAtKnot : kLeastLead) * largest)
        g[lead++] = 0.0;
      if (lead > degree) continue;
      const std::optional<double> s = g[lead] < 0.0 ? std::optional(0.0) : first_crossing(g, end);
      if (!s) continue;
      first = s;
      end = *s;
      leaving_ = &l;
      leaving_direction_ = side;
    }
  });
  return first;
}

double LoadSeries::work(TaylorSeries& series, double s, const Vector& end) {
  if (projected_) {
    // p_ by powers: what was projected beside what add_to() put there.
    (with_laws_ ? of_loads_ : projection_).add_powers(3, p_.data());
    projected_ = false;
  }
  const double sum = series.work(p_.data(), degree_, s) + expanded_.work(series, s);
  return sum + straight_.slope_work(series, end) + smooth_.slope_work(series, s, end);
}

}  // namespace drev
