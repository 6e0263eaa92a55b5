#include "solvers/periodic/branch_tracer.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"
#include "solvers/periodic/bracketed_search.hpp"

namespace drev {

namespace {

constexpr int kMostIterations = 12;
constexpr double kSolved = 1e-10;    // last step of Newton's method relative to X and w [-]
constexpr double kFirstStep = 5e-3;  // first step along the arc relative to the size of X and w [-]
constexpr double kLongest = 0.05;    // longest step, likewise [-]
constexpr double kShortest = 1e-7;
constexpr double kLeastCosine = 0.95;  // smallest cosine of the angle between neighbouring tangents [-]
constexpr int kLocations = 40;         // largest number of iterations that locate a change
constexpr double kLocated = 1e-9;      // last step of these over the chord [-]
// Subharmonic part relative to X at which a curve has ended on the curve of a single cycle [-].
constexpr double kJoined = 2e-3;
// Relative change of speed up to which an extremum is no fold [-]: vertical curves turn to and fro by
// rounding.
constexpr double kUpright = 1e-8;

}  // namespace

BranchTracer::BranchTracer(LawBalance& balance, const FloquetProduct* stability, const Options& options)
    : balance_(balance), stability_(stability), options_(options) {}

Vector BranchTracer::joined(double speed, const Vector& x) const {
  Vector u(x.size() + 1);
  u << x, speed;
  return u;
}

double BranchTracer::dot(const Vector& a, const Vector& b) const { return a.cwiseProduct(scale_).dot(b); }

Vector BranchTracer::subharmonic(const Vector& u, int part_of_period) const {
  Vector part = u;
  const Eigen::Index block = 2 * balance_.harmonics() + 1;
  part[u.size() - 1] = 0.0;
  for (int i = 0; i < balance_.inputs(); ++i) {
    part[i * block] = 0.0;
    for (int n = part_of_period; n <= balance_.harmonics(); n += part_of_period)
      part.segment(i * block + 2 * n - 1, 2).setZero();
  }
  return part;
}

bool BranchTracer::meets_fewer_cycles(const Vector& u, const Vector& next) const {
  for (int part = 2; part <= options_.cycles; ++part) {
    if (options_.cycles % part != 0) continue;
    const Vector before = subharmonic(u, part), after = subharmonic(next, part);
    if (dot(before, after) < 0.0 ||
        (dot(after, after) < kJoined * kJoined && dot(after, after) < dot(before, before)))
      return true;
  }
  return false;
}

bool BranchTracer::solve(double speed, Vector& x) {
  Vector r, next_r;
  if (!balance_.residual(x, speed, r)) return false;
  for (int k = 0; k < 40; ++k) {
    const Vector d = lu_solve(balance_.tangent(), Vector(-r));
    if (!d.allFinite()) return false;
    const double left = r.norm();
    double part = 1.0;
    Vector next;
    for (;; part *= 0.5) {
      if (part < 1.0 / 256) return false;
      next = x + part * d;
      if (balance_.residual(next, speed, next_r) &&
          (next_r.norm() <= (1.0 - 1e-2 * part) * left || d.norm() <= 1e-12 * x.norm()))
        break;
      // At the level of rounding the residual no longer decreases.
      if (d.norm() <= kSolved * x.norm()) return true;
    }
    x = next;
    r = next_r;
    if (part == 1.0 && d.norm() <= kSolved * x.norm()) return true;
  }
  return false;
}

BranchPoint BranchTracer::judged(double speed, Vector x) {
  BranchPoint point;
  Vector r;
  balance_.residual(x, speed, r);
  point.speed = speed;
  point.harmonics = balance_.harmonics();
  point.closed = balance_.closed();
  if (stability_ != nullptr) {
    const FloquetMultipliers all = stability_->multipliers(balance_, speed);
    point.multiplier = all.largest;
    point.stable = all.outside == 0 && std::isfinite(all.largest);
    point.at_minus_one = all.at_minus_one;
    point.outside = all.outside;
    point.complex_outside = all.complex_outside;
  }
  point.x = std::move(x);
  return point;
}

BranchPoint BranchTracer::point_at(const Vector& u) { return judged(u[u.size() - 1], u.head(u.size() - 1)); }

/// The matrix of both equations at u, with slope_ as last evaluated, and R.
bool BranchTracer::linearize(const Vector& u, const Vector& normal, Eigen::MatrixXd& matrix, Vector& r) {
  const Eigen::Index n = u.size() - 1;
  if (!(u[n] > 0.0) || !balance_.residual(u.head(n), u[n], r)) return false;
  matrix.resize(n + 1, n + 1);
  matrix.topLeftCorner(n, n) = balance_.tangent();
  matrix.topRightCorner(n, 1) = slope_;
  matrix.bottomRows(1) = normal.cwiseProduct(scale_).transpose();
  return true;
}

bool BranchTracer::correct(const Vector& normal, const Vector& target, double tolerance, Vector& u,
                           int& iterations) {
  Eigen::MatrixXd matrix;
  Vector r, right(u.size());
  double last = 0.0;
  for (iterations = 1; iterations <= kMostIterations; ++iterations) {
    if (!linearize(u, normal, matrix, r)) return false;
    right << -r, -dot(normal, u - target);
    const Vector d = lu_solve(matrix, right);
    if (!d.allFinite()) return false;
    u += d;
    const double size = std::sqrt(dot(d, d));
    if (size <= tolerance) return true;
    if (iterations > 3 && size > last) return last <= 100.0 * tolerance;
    last = size;
  }
  return false;
}

bool BranchTracer::tangent(const Vector& u, const Vector& along, Vector& t) {
  Eigen::MatrixXd matrix;
  Vector r;
  const Eigen::Index n = u.size() - 1;
  if (!balance_.speed_slope(u.head(n), u[n], slope_) || !linearize(u, along, matrix, r)) return false;
  Vector right = Vector::Zero(u.size());
  right[n] = 1.0;
  t = lu_solve(matrix, right);
  t /= std::sqrt(dot(t, t));
  return t.allFinite();
}

/// Updates the sizes that steps are measured by where the motion has grown.
void BranchTracer::rescale(const Vector& x) {
  const Eigen::Index block = 2 * balance_.harmonics() + 1;
  for (int i = 0; i < balance_.inputs(); ++i) {
    const double size = x.segment(i * block, block).norm();
    if (size * size * scale_[i * block] > 1.0 || scale_[i * block] == 1.0)
      scale_.segment(i * block, block).setConstant(size > 0.0 ? 1.0 / (size * size) : 1.0);
  }
}

std::vector<BranchPoint> BranchTracer::follow(double speed, const Vector& x, double direction, bool& whole) {
  const Eigen::Index n = x.size();
  scale_ = Vector::Constant(n + 1, 1.0);
  scale_[n] = 1.0 / (speed * speed);
  rescale(x);
  std::vector<BranchPoint> points{judged(speed, x)};
  turns_.clear();
  whole = false;
  Vector u = joined(speed, x), t, along = Vector::Zero(n + 1);
  along[n] = direction * speed;
  if (!tangent(u, along, t)) return points;
  if (t[n] * direction < 0.0) t = -t;
  turns_.push_back(t[n]);
  const Vector start = u, start_t = t;
  double step = kFirstStep;
  while (static_cast<int>(points.size()) < options_.most_points) {
    Vector next = u + step * t, next_t;
    const Vector target = next, slope = slope_;
    int iterations = 0;
    bool done = correct(t, target, kSolved, next, iterations) && tangent(next, t, next_t) &&
                dot(next_t, t) >= kLeastCosine;
    if (!done) {
      slope_ = slope;
      step *= 0.5;
      if (step < kShortest) return points;
      continue;
    }
    const double w = next[n];
    if (w <= options_.low || w >= options_.high) {
      // The last point is at the end of the speed range.
      const double end = w <= options_.low ? options_.low : options_.high;
      const BranchPoint beyond = {.speed = w, .x = next.head(n), .harmonics = balance_.harmonics()};
      if (auto last = between(points.back(), beyond, end)) {
        points.push_back(std::move(*last));
        turns_.push_back(next_t[n]);
        whole = true;
      }
      return points;
    }
    points.push_back(point_at(next));
    turns_.push_back(next_t[n]);
    if (meets_fewer_cycles(u, next)) {
      whole = true;
      return points;
    }
    // Check whether the curve has passed its start.
    const Vector chord = next - u, gap = start - u;
    const double part = dot(gap, chord) / dot(chord, chord);
    const Vector beside = gap - part * chord;
    if (points.size() > 10 && part > 0.0 && part <= 1.0 && dot(start_t, chord) > 0.0 &&
        dot(beside, beside) < 0.04 * dot(chord, chord)) {
      points.push_back(points.front());
      turns_.push_back(turns_.front());
      whole = true;
      return points;
    }
    u = next;
    rescale(u.head(n));
    t = next_t / std::sqrt(dot(next_t, next_t));
    if (iterations <= 3) step = std::min(1.5 * step, kLongest);
    if (iterations >= 6) step *= 0.5;
  }
  return points;
}

Branch BranchTracer::trace(double speed, const Vector& x) {
  Branch branch;
  bool up = true, down = true;
  std::vector<double> turns;
  if (speed > options_.low) {
    branch.points = follow(speed, x, -1.0, down);
    std::reverse(branch.points.begin(), branch.points.end());
    turns.assign(turns_.rbegin(), turns_.rend());
    for (double& turn : turns) turn = -turn;
  }
  const bool loop = branch.points.size() > 1 && branch.points.front().speed == branch.points.back().speed;
  if (speed < options_.high && !loop) {
    std::vector<BranchPoint> rest = follow(speed, x, 1.0, up);
    const std::ptrdiff_t known = branch.points.empty() ? 0 : 1;
    branch.points.insert(branch.points.end(), rest.begin() + known, rest.end());
    turns.insert(turns.end(), turns_.begin() + std::min<std::ptrdiff_t>(known, std::ssize(turns_)),
                 turns_.end());
  }
  branch.whole = up && down;
  const int harmonics = balance_.harmonics();
  std::vector<BranchPoint> points = std::move(branch.points);
  branch.points.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    branch.points.push_back(points[i]);
    if (i + 1 == points.size()) break;
    const BranchPoint &from = points[i], &to = points[i + 1];
    const bool folds = i + 1 < turns.size() && turns[i] * turns[i + 1] < 0.0;
    if (folds) find_fold(from, to, turns[i] > 0.0 ? 1.0 : -1.0, branch);
    find_events(from, to, folds, branch);
    balance_.set_harmonics(harmonics);
  }
  return branch;
}

/// The point of the branch on a plane across the chord.
bool BranchTracer::across(const Vector& from, const Vector& to, double part, Vector& u) {
  const Vector chord = to - from;
  const Vector target = from + part * chord;
  u = target;
  int iterations = 0;
  return correct(chord / std::sqrt(dot(chord, chord)), target, 1e-12, u, iterations);
}

std::optional<BranchPoint> BranchTracer::between(const BranchPoint& from, const BranchPoint& to,
                                                 double speed) {
  const double part = (speed - from.speed) / (to.speed - from.speed);
  const Vector chord = to.x - from.x;
  const Vector guess = from.x + part * chord;
  for (const Vector* start : {&guess, &from.x, &to.x}) {
    Vector x = *start;
    if (solve(speed, x) && (x - guess).norm() <= 0.6 * chord.norm() + 1e-9 * x.norm())
      return judged(speed, x);
  }
  return std::nullopt;
}

bool BranchTracer::widen(double part, double beside, Vector& a, Vector& b) {
  Vector low, high;
  if (!balance_.speed_slope(a.head(a.size() - 1), a[a.size() - 1], slope_) ||
      !across(a, b, std::max(0.0, part - beside), low) || !across(a, b, std::min(1.0, part + beside), high))
    return false;
  const int h = balance_.harmonics();
  const Vector chord = high - low, scale = scale_;
  balance_.set_harmonics(2 * h);
  const Eigen::Index rows = 2 * balance_.harmonics() + 1;
  const auto widened = [&](const Vector& v) {
    return joined(v[v.size() - 1], balance_.resized(v.head(v.size() - 1), h, 2 * h));
  };
  Vector wide = Vector::Ones(balance_.size() + 1);
  for (int i = 0; i < balance_.inputs(); ++i)
    wide.segment(i * rows, rows).setConstant(scale[i * (2 * h + 1)]);
  wide[wide.size() - 1] = scale[scale.size() - 1];
  scale_ = wide;
  low = widened(low), high = widened(high);
  const Vector normal = widened(chord) / std::sqrt(dot(widened(chord), widened(chord)));
  const Vector low_target = low, high_target = high;
  int iterations = 0;
  if (!balance_.speed_slope(low.head(low.size() - 1), low[low.size() - 1], slope_) ||
      !correct(normal, low_target, 1e-12, low, iterations) ||
      !correct(normal, high_target, 1e-12, high, iterations))
    return false;
  a = low, b = high;
  return true;
}

void BranchTracer::find_change(const BranchPoint& from, const BranchPoint& to, BranchEvent::Kind kind,
                               const Locate& locate, Branch& branch) {
  Vector a = joined(from.speed, from.x), b = joined(to.speed, to.x), u;
  const Vector scale = scale_;
  std::optional<double> part = locate(a, b, u);
  if (!part) return;
  BranchEvent event{kind, u[u.size() - 1], NAN, point_at(u)};
  if (kind == BranchEvent::Kind::fold) branch.points.push_back(event.point);
  // Locate it anew between two nearby points on either side, or on the whole chord, with twice the harmonics.
  const auto sharpen = [&](double beside) {
    Vector low = a, high = b;
    const int h = balance_.harmonics();
    const Vector before = scale_;
    const std::optional<double> next = widen(*part, beside, low, high) ? locate(low, high, u) : std::nullopt;
    if (next) {
      a = low, b = high, part = next;
      return true;
    }
    scale_ = before;
    balance_.set_harmonics(h);
    return false;
  };
  constexpr double kNear = 0.05;
  while (2 * balance_.size() <= options_.most_rows && (sharpen(kNear) || sharpen(1.0))) {
    const double speed = u[u.size() - 1];
    event.error = std::abs(speed - event.speed);
    event.speed = speed;
    event.point = point_at(u);
    if (event.error <= options_.tolerance * speed) break;
  }
  // The speed is solved for no farther.
  if (std::isfinite(event.error)) event.error = std::max(event.error, kSolved * event.speed);
  scale_ = scale;
  branch.events.push_back(std::move(event));
  balance_.set_harmonics(from.harmonics);
}

void BranchTracer::find_fold(const BranchPoint& from, const BranchPoint& to, double sign, Branch& branch) {
  find_change(
      from, to, BranchEvent::Kind::fold,
      [&](const Vector& a, const Vector& b, Vector& u) -> std::optional<double> {
        const Eigen::Index n = a.size() - 1;
        if (!balance_.speed_slope(a.head(n), a[n], slope_)) return std::nullopt;
        bool failed = false;
        const BracketedMaximum best = bracketed_maximum(0.0, 0.5, 1.0, 1e-5, [&](double part) {
          if (failed || !across(a, b, part, u)) {
            failed = true;
            return -1e300;
          }
          return sign * u[n];
        });
        if (failed || !across(a, b, best.at, u)) return std::nullopt;
        if (std::max(std::abs(u[n] - from.speed), std::abs(u[n] - to.speed)) <= kUpright * u[n])
          return std::nullopt;
        return best.at;
      },
      branch);
}

template <class Differs>
void BranchTracer::bisect(const BranchPoint& from, const BranchPoint& to, BranchEvent::Kind kind,
                          const Differs& differs, Branch& branch) {
  find_change(
      from, to, kind,
      [&](const Vector& a, const Vector& b, Vector& u) -> std::optional<double> {
        if (differs(point_at(a)) || !differs(point_at(b)) ||
            !balance_.speed_slope(a.head(a.size() - 1), a[a.size() - 1], slope_))
          return std::nullopt;
        double low = 0.0, high = 1.0;
        for (int k = 0; k < kLocations && (high - low) > kLocated; ++k) {
          const double middle = 0.5 * (low + high);
          if (!across(a, b, middle, u)) return std::nullopt;
          (differs(point_at(u)) ? high : low) = middle;
        }
        if (!across(a, b, high, u)) return std::nullopt;
        return high;
      },
      branch);
}

/// Locates the point where the product of all 1 + multiplier is 0, by the Illinois method.
void BranchTracer::find_doubling(const BranchPoint& from, const BranchPoint& to, Branch& branch) {
  find_change(
      from, to, BranchEvent::Kind::period_doubling,
      [&](const Vector& a, const Vector& b, Vector& u) -> std::optional<double> {
        IllinoisBracket bracket{0.0, point_at(a).at_minus_one, 1.0, point_at(b).at_minus_one};
        if (!(bracket.f_low * bracket.f_high < 0.0) ||
            !balance_.speed_slope(a.head(a.size() - 1), a[a.size() - 1], slope_))
          return std::nullopt;
        double root = 0.0, last = 0.0;
        for (int k = 0; k < kLocations; ++k) {
          last = root;
          root = bracket.next();
          if (!across(a, b, root, u)) return std::nullopt;
          const double here = point_at(u).at_minus_one;
          if (here == 0.0 || (k > 0 && std::abs(root - last) < kLocated)) break;
          bracket.take(root, here);
        }
        return root;
      },
      branch);
}

void BranchTracer::find_events(const BranchPoint& from, const BranchPoint& to, bool folds, Branch& branch) {
  if (from.closed != to.closed)
    bisect(
        from, to, BranchEvent::Kind::contact, [&](const BranchPoint& p) { return p.closed == to.closed; },
        branch);
  if (stability_ == nullptr) return;
  const bool doubles = from.at_minus_one * to.at_minus_one < 0.0;
  if (doubles) find_doubling(from, to, branch);
  if (std::abs(from.outside - to.outside) == 1 && !doubles && !folds)
    bisect(
        from, to, BranchEvent::Kind::branching, [&](const BranchPoint& p) { return p.outside == to.outside; },
        branch);
  if (from.outside != to.outside && (from.complex_outside || to.complex_outside) &&
      std::abs(from.outside - to.outside) == 2)
    bisect(
        from, to, BranchEvent::Kind::torus, [&](const BranchPoint& p) { return p.outside == to.outside; },
        branch);
}

}  // namespace drev
