#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/models/gears/mesh_cycle.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "core/names/rounded_text.hpp"
#include "models/gears/tooth_compliance.hpp"

namespace drev {
namespace {

constexpr double kErrorDivisor = 3.0;  // of the difference to the coarser mesh: order 2 at least
constexpr double kSlicesPerPitch = 24.0;

void check_options(const MeshCycleOptions& o) {
  std::vector<Finding> findings;
  ParameterCheck check("mesh cycle", findings);
  check.positive("load", o.load, "N/m");
  check.within("points", o.points, 4, 1000, "");
  check.within("level", o.level, 2, 8, "");
  if (o.level % 2 != 0) check.fail("level", std::to_string(o.level), "", "must be even");
  for (const TipRelief& relief : o.tip_relief) {
    check.non_negative("tip_relief", relief.depth, "m");
    if (relief.depth > 0.0) check.positive("tip_relief_length", relief.length, "m");
  }
  if (o.pitch_deviations.size() > 200)
    check.fail("pitch_deviations", std::to_string(o.pitch_deviations.size()), "", "must be at most 200");
  check.all_finite("pitch_deviations", o.pitch_deviations, "m");
  if (!std::isnan(o.overlap_ratio)) check.within("overlap_ratio", o.overlap_ratio, 0.0, 20.0, "");
  if (!findings.empty()) throw ModelError(std::move(findings));
}

[[noreturn]] void refuse_load(double load, const std::string& why) {
  throw ModelError({{"mesh cycle", "load", to_text(load), "N/m",
                     why + ": contacts too wide or bodies too unlike for the method"}});
}

/// Pairs of one slice at one phase: what they need to carry a force.
struct Slice {
  int count = 0;
  std::array<int, MeshPoint::kMostPairs> order{};      // 0: the entering pair, 1: the one before it, ...
  std::array<double, MeshPoint::kMostPairs> linear{};  // A of c(F) = A - B ln F
  std::array<double, MeshPoint::kMostPairs> gap{};     // e
  std::array<std::array<double, MeshPoint::kMostPairs>, MeshPoint::kMostPairs> coupling{};
};

struct SliceForces {
  double total = 0.0, slope = 0.0;  // per width; d total/d delta
  std::array<double, MeshPoint::kMostPairs> force{};
};

/// Solves A x = b, A symmetric positive definite up to rounding, of n <= 5 unknowns, by elimination.
void eliminate(std::array<std::array<double, 5>, 5>& a, std::array<std::array<double, 2>, 5>& b, int n) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[at(i)][at(k)] / a[at(k)][at(k)];
      for (int j = k; j < n; ++j) a[at(i)][at(j)] -= factor * a[at(k)][at(j)];
      for (std::size_t c = 0; c < 2; ++c) b[at(i)][c] -= factor * b[at(k)][c];
    }
  for (int k = n - 1; k >= 0; --k)
    for (std::size_t c = 0; c < 2; ++c) {
      for (int j = k + 1; j < n; ++j) b[at(k)][c] -= a[at(k)][at(j)] * b[at(j)][c];
      b[at(k)][c] /= a[at(k)][at(k)];
    }
}

/// The pair's gears at one level of their meshes.
class Mesh {
 public:
  Mesh(const GearPair& pair, const MeshCycleOptions& options, int level);

  Slice slice(double phase) const;  // phase in mesh periods from the first one's begin
  SliceForces forces(const Slice& slice, double delta) const;
  MeshPoint point(double phase) const;
  double force(double phase, double approach) const;
  double single_pair(double t) const;
  int unknowns() const { return gears_[0].unknowns(); }
  double overlap() const { return overlap_; }

 private:
  /// The slices of a phase, and delta_0.
  std::vector<Slice> slices(double phase, double& unloaded) const;
  double corner_gap(int tip_gear, double beyond, double& flank_length) const;
  double linear_part(double t_1, double t_2) const;
  double relief(double t_1, double t_2) const;

  const GearPair& pair_;
  const MeshCycleOptions& options_;
  std::array<ToothCompliance, 2> gears_;
  std::array<double, 2> modulus_, low_, high_, windup_{};
  double hertz_ = 0.0, constant_ = 0.0, overlap_;
};

ToothCompliance flank_of(const GearPair& pair, int gear, int level) {
  const double from = pair.start_of_contact(), to = pair.end_of_contact();
  if (gear == 0) return {pair, 0, from, to, level};
  return {pair, 1, std::min(pair.second_length(from), pair.second_length(to)),
          std::max(pair.second_length(from), pair.second_length(to)), level};
}

Mesh::Mesh(const GearPair& pair, const MeshCycleOptions& options, int level)
    : pair_(pair), options_(options), gears_{flank_of(pair, 0, level), flank_of(pair, 1, level)} {
  double shape = 0.0;
  const double m = pair.geometry().module;
  for (int i = 0; i < 2; ++i) {
    const GearMaterial& material = pair.gear(i).material;
    const double nu = material.poisson_ratio, part = (1.0 - nu * nu) / (kPi * material.youngs_modulus);
    modulus_[static_cast<std::size_t>(i)] = material.youngs_modulus;
    hertz_ += part;
    constant_ += part * (2.0 * std::log(2.0 * m) - nu / (1.0 - nu));
    shape += 4.0 * part;
    if (!options.windup)
      windup_[static_cast<std::size_t>(i)] = MeshCycle::windup(pair, i) / material.youngs_modulus;
  }
  constant_ -= hertz_ * std::log(shape);
  low_ = {pair.start_of_contact(), pair.second_length(pair.end_of_contact())};
  high_ = {pair.end_of_contact(), pair.second_length(pair.start_of_contact())};
  if (low_[1] > high_[1]) std::swap(low_[1], high_[1]);  // of a ring
  overlap_ = std::isnan(options.overlap_ratio) ? pair.overlap_ratio() : options.overlap_ratio;
}

double Mesh::linear_part(double t_1, double t_2) const {
  return gears_[0].own(t_1) / modulus_[0] - windup_[0] + gears_[1].own(t_2) / modulus_[1] - windup_[1] +
         constant_ - hertz_ * std::log(t_1 * t_2 / pair_.tangent_length());
}

double Mesh::relief(double t_1, double t_2) const {
  const auto of = [&](const TipRelief& r, double from_tip) {
    return r.depth > 0.0 ? r.depth * std::clamp(1.0 - from_tip / r.length, 0.0, 1.0) : 0.0;
  };
  return of(options_.tip_relief[0], pair_.contour(0).tip_length() - t_1) +
         of(options_.tip_relief[1], std::abs(pair_.contour(1).tip_length() - t_2));
}

/// Distance along the line of action of the tip's corner of `tip_gear` from the flank of the other gear, `beyond` (m of
/// the line of action) outside the path of contact, and where on that flank it would touch. All angles from the line of
/// centres, positive towards where the corner is: the corner stands at b about its own axis, at (x, y) about the other; the
/// flank's place of radius R stands at alpha_w - atan(t/r_b) + (t - tau)/r_b, tau its contact on the line of action (beyond
/// the end of the path a ring's flank lies on the other side of the line of centres than its tangent point).
double Mesh::corner_gap(int tip_gear, double beyond, double& flank_length) const {
  const ToothContour &tip = pair_.contour(tip_gear), &flank = pair_.contour(1 - tip_gear);
  const double a = pair_.centre_distance(), radius = tip.usable_tip_radius(), base = flank.base_radius();
  const bool on_ring = pair_.geometry().internal && tip_gear == 0, of_ring = pair_.is_ring(tip_gear);
  const double tangent = pair_.tangent_length(), length = tip.tip_length();
  const double t_end = on_ring ? tangent + length : of_ring ? length - tangent : tangent - length;
  const double tau = on_ring ? t_end + beyond : t_end - beyond;
  const double at_end = std::atan2(length, tip.base_radius()) - pair_.operating_angle();
  const double b = (of_ring ? -at_end : at_end) + beyond / tip.base_radius();
  const double x = on_ring   ? a + radius * std::cos(b)
                   : of_ring ? radius * std::cos(b) - a
                             : a - radius * std::cos(b);
  const double y = radius * std::sin(b), t_square = x * x + y * y - base * base;
  flank_length = std::sqrt(std::max(t_square, 0.0));
  const double place = pair_.operating_angle() - std::atan2(flank_length, base) + (flank_length - tau) / base;
  const double gap = base * ((on_ring ? -place : place) - std::atan2(y, x));
  return t_square > 0.0 ? gap : std::numeric_limits<double>::infinity();
}

Slice Mesh::slice(double phase) const {
  Slice s;
  const double from = pair_.start_of_contact(), to = pair_.end_of_contact(), pitch = pair_.base_pitch();
  const double whole = std::floor(phase), first = from + (phase - whole) * pitch;
  std::array<double, MeshPoint::kMostPairs> t_1{}, t_2{};
  const double margin = options_.corner_contact ? 0.5 * pitch : 0.0;
  for (int k = options_.corner_contact ? -1 : 0; first + k * pitch <= to + margin; ++k) {
    double t = first + k * pitch, gap = 0.0;
    if (t < from - margin || s.count == MeshPoint::kMostPairs) continue;
    const auto i = static_cast<std::size_t>(s.count);
    if (t < from || t > to) {
      double length = 0.0;
      gap = t < from ? corner_gap(1, from - t, length) : corner_gap(0, t - to, length);
      if (!std::isfinite(gap)) continue;
    }
    t_1[i] = std::clamp(t, low_[0], high_[0]);
    t_2[i] = std::clamp(pair_.second_length(t_1[i]), low_[1], high_[1]);
    s.order[i] = k;
    s.gap[i] = gap + relief(t_1[i], t_2[i]);
    if (!options_.pitch_deviations
             .empty()) {  // the pair that enters now is number floor(phase); older ones come before
      const auto n = static_cast<int>(options_.pitch_deviations.size());
      const int number = ((static_cast<int>(whole) - k) % n + n) % n;
      s.gap[i] += options_.pitch_deviations[static_cast<std::size_t>(number)];
    }
    s.linear[i] = linear_part(t_1[i], t_2[i]);
    ++s.count;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i)
    for (std::size_t j = i + 1; j < static_cast<std::size_t>(s.count); ++j) {
      const int d = static_cast<int>(j - i);
      const double second =
          t_2[i] > t_2[j] ? gears_[1].coupling(d, t_2[i], t_2[j]) : gears_[1].coupling(d, t_2[j], t_2[i]);
      s.coupling[i][j] = s.coupling[j][i] = gears_[0].coupling(d, t_1[j], t_1[i]) / modulus_[0] - windup_[0] +
                                            second / modulus_[1] - windup_[1];
    }
  return s;
}

/// Forces at the approach delta, by Newton's method over the pairs that carry; those that would pull are taken out, those
/// that would overlap put in.
SliceForces Mesh::forces(const Slice& s, double delta) const {
  const auto n = static_cast<std::size_t>(s.count);
  std::array<bool, MeshPoint::kMostPairs> carries{};
  SliceForces f;
  for (std::size_t i = 0; i < n; ++i) {
    if (delta > s.gap[i] && s.linear[i] > 0.0) f.force[i] = 0.5 * (delta - s.gap[i]) / s.linear[i];
    carries[i] = f.force[i] > 0.0;
  }
  for (int round = 0; round < 12; ++round) {
    std::array<std::size_t, 5> active{};
    int m = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (carries[i]) active[static_cast<std::size_t>(m++)] = i;
    bool dropped = false;
    for (int iteration = 0; iteration < 30 && m > 0 && !dropped; ++iteration) {
      std::array<std::array<double, 5>, 5> a{};
      std::array<std::array<double, 2>, 5> b{};
      for (int p = 0; p < m; ++p) {
        const std::size_t i = active[static_cast<std::size_t>(p)];
        const double own = s.linear[i] - hertz_ * std::log(f.force[i]);
        double missing = delta - s.gap[i] - f.force[i] * own;
        for (int q = 0; q < m; ++q) {
          const std::size_t j = active[static_cast<std::size_t>(q)];
          if (i != j) missing -= s.coupling[i][j] * f.force[j];
          a[static_cast<std::size_t>(p)][static_cast<std::size_t>(q)] =
              i == j ? own - hertz_ : s.coupling[i][j];
        }
        b[static_cast<std::size_t>(p)] = {missing, 1.0};
      }
      eliminate(a, b, m);
      double change = 0.0, size = 0.0;
      f.slope = 0.0;
      for (int p = 0; p < m; ++p) {
        const std::size_t i = active[static_cast<std::size_t>(p)];
        double next = f.force[i] + b[static_cast<std::size_t>(p)][0];
        if (next <= 0.0) {
          next = 0.05 * f.force[i];
          if (iteration > 8) carries[i] = false, next = 0.0, dropped = true;
        }
        change = std::max(change, std::abs(next - f.force[i]));
        size = std::max(size, next);
        f.force[i] = next;
        f.slope += b[static_cast<std::size_t>(p)][1];
      }
      if (change <= 1e-12 * size) break;
    }
    if (dropped) continue;
    bool added = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (carries[i]) continue;
      double distance = s.gap[i] - delta;
      for (std::size_t j = 0; j < n; ++j) distance += s.coupling[i][j] * f.force[j];
      if (distance < -1e-13) carries[i] = added = true, f.force[i] = -0.5 * distance / s.linear[i];
    }
    if (!added) break;
  }
  f.total = 0.0;
  for (std::size_t i = 0; i < n; ++i) f.total += f.force[i];
  if (f.total == 0.0) f.slope = 0.0;
  return f;
}

std::vector<Slice> Mesh::slices(double phase, double& unloaded) const {
  const int count = overlap_ > 0.0 ? std::max(8, static_cast<int>(std::ceil(kSlicesPerPitch * overlap_))) : 1;
  std::vector<Slice> all;
  unloaded = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    all.push_back(slice(phase + overlap_ * (i + 0.5) / count - (count > 1 ? 0.0 : 0.5 * overlap_)));
    for (int k = 0; k < all.back().count; ++k)
      unloaded = std::min(unloaded, all.back().gap[static_cast<std::size_t>(k)]);
  }
  return all;
}

double Mesh::force(double phase, double approach) const {
  if (!(approach > 0.0)) return 0.0;
  double unloaded = 0.0, total = 0.0;
  const std::vector<Slice> all = slices(phase, unloaded);
  for (const Slice& slice : all) total += forces(slice, unloaded + approach).total;
  return total / static_cast<double>(all.size());
}

MeshPoint Mesh::point(double phase) const {
  double unloaded = 0.0;
  const std::vector<Slice> all = this->slices(phase, unloaded);
  const auto slices = static_cast<int>(all.size());
  const double w = options_.load;
  // The forces grow with delta: Newton's method within a bracket.
  double low = unloaded, high = std::numeric_limits<double>::infinity();
  double delta = unloaded + w * std::max(all.front().linear[0], 0.0);
  std::vector<SliceForces> forces(all.size());
  double total = 0.0, slope = 0.0;
  constexpr int kMostIterations = 200;
  for (int iteration = 0;; ++iteration) {
    total = slope = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      forces[i] = this->forces(all[i], delta);
      total += forces[i].total / slices;
      slope += forces[i].slope / slices;
    }
    if (std::abs(total - w) <= 1e-9 * w || (std::isfinite(high) && high - low <= 1e-14 * (high - unloaded)))
      break;
    if (iteration == kMostIterations || !std::isfinite(total))
      refuse_load(w, "finds no balance at the phase " + to_text(phase));
    (total < w ? low : high) = delta;
    const double next = slope > 0.0 ? delta + (w - total) / slope : high;
    const double middle = std::isfinite(high) ? 0.5 * (low + high) : unloaded + 2.0 * (delta - unloaded);
    delta = next > low && next < high && iteration % 8 != 7 ? next : middle;
  }
  MeshPoint p;
  p.phase = phase;
  p.t = pair_.start_of_contact() + (phase - std::floor(phase)) * pair_.base_pitch();
  p.loaded_error = delta;
  p.unloaded_error = unloaded;
  p.secant = w / (delta - unloaded);
  p.tangent = slope;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (int k = 0; k < all[i].count; ++k) {
      const double force = forces[i].force[static_cast<std::size_t>(k)];
      if (force <= 0.0) continue;
      p.pairs += 1.0 / slices;
      const int order = std::max(all[i].order[static_cast<std::size_t>(k)], 0);
      if (slices == 1 && order < MeshPoint::kMostPairs)
        p.shares[static_cast<std::size_t>(order)] += force / total;
    }
  return p;
}

double Mesh::single_pair(double t) const {
  return 1.0 / (linear_part(t, pair_.second_length(t)) - hertz_ * std::log(options_.load));
}

MeshFigures figures_of(const std::vector<MeshPoint>& points, double single) {
  MeshFigures f;
  const auto n = static_cast<double>(points.size());
  double low = points.front().loaded_error, high = low;
  f.highest = f.lowest = points.front().secant;
  for (const MeshPoint& p : points) {
    f.mean += p.secant / n;
    f.tangent_mean += p.tangent / n;
    f.highest = std::max(f.highest, p.secant);
    f.lowest = std::min(f.lowest, p.secant);
    f.error_mean += p.loaded_error / n;
    low = std::min(low, p.loaded_error);
    high = std::max(high, p.loaded_error);
    f.loaded_contact_ratio += p.pairs / n;
  }
  f.error_peak_to_peak = high - low;
  f.single_pair = single;
  return f;
}

}  // namespace

namespace {

/// Contacts that are not narrow beside the teeth are none of Hertz's.
void check_load(const GearPair& pair, double load) {
  constexpr double kWidest = 0.2;  // half width of a contact, modules
  double shape = 0.0;
  for (int i = 0; i < 2; ++i) {
    const GearMaterial& m = pair.gear(i).material;
    shape += 4.0 / kPi * (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
  }
  const double t = pair.pitch_point(), t_2 = pair.second_length(t), m = pair.geometry().module;
  const double most = std::pow(kWidest * m, 2) / (shape * t * t_2 / pair.tangent_length());
  if (load > most)
    throw ModelError({{"mesh cycle", "load", to_text(load / 1e3), "N/mm",
                       "must be at most " + rounded_text(most / 1e3, 4) +
                           " N/mm for these teeth: their contacts would be wider than Hertz's"}});
}

}  // namespace

MeshCycle::MeshCycle(const GearPair& pair, const MeshCycleOptions& options) : options_(options) {
  check_options(options_);
  check_load(pair, options_.load);
  const auto shared = std::make_shared<GearPair>(pair);  // single_ outlives the arguments
  const auto kept = std::make_shared<MeshCycleOptions>(options);
  const auto fine = std::make_shared<Mesh>(*shared, *kept, options_.level);
  const Mesh coarse(*shared, *kept, options_.level / 2);
  const int periods = std::max(1, static_cast<int>(options_.pitch_deviations.size()));
  std::vector<MeshPoint> rough;
  const int stride = std::max(1, options_.points / 50);
  for (int i = 0; i < periods * options_.points; ++i) {
    const double phase = (i + 0.5) / options_.points;
    points_.push_back(fine->point(phase));
    if (i % stride == 0) rough.push_back(coarse.point(phase));
  }
  std::vector<MeshPoint> same;
  for (std::size_t i = 0; i < points_.size(); i += static_cast<std::size_t>(stride))
    same.push_back(points_[i]);
  single_ = [fine, shared, kept](double t) { return fine->single_pair(t); };
  force_ = [fine, shared, kept](double phase, double approach) { return fine->force(phase, approach); };
  const double pitch_point = std::clamp(pair.pitch_point(), pair.start_of_contact(), pair.end_of_contact());
  figures_ = figures_of(points_, single_(pitch_point));
  const MeshFigures finer = figures_of(same, figures_.single_pair);
  const MeshFigures other = figures_of(rough, coarse.single_pair(pitch_point));
  const auto error = [&](double MeshFigures::*value) {
    errors_.*value = std::abs(other.*value - finer.*value) / kErrorDivisor;
  };
  for (const auto value : {&MeshFigures::mean, &MeshFigures::tangent_mean, &MeshFigures::highest,
                           &MeshFigures::lowest, &MeshFigures::error_mean, &MeshFigures::error_peak_to_peak,
                           &MeshFigures::loaded_contact_ratio, &MeshFigures::single_pair})
    error(value);
  for (const double value : {figures_.mean, figures_.tangent_mean, figures_.lowest, figures_.error_mean,
                             figures_.single_pair, figures_.loaded_contact_ratio})
    if (!(value > 0.0) || !std::isfinite(value)) refuse_load(options_.load, "gives no positive stiffness");
  unknowns_ = fine->unknowns();
}

std::vector<Harmonic> MeshCycle::harmonics(int count, double MeshPoint::*value) const {
  std::vector<Harmonic> list;
  const int n = options_.points;
  for (int order = 1; order <= std::min(count, (n - 1) / 2); ++order) {
    double c = 0.0, s = 0.0;
    for (int i = 0; i < n; ++i) {
      const MeshPoint& p = points_[static_cast<std::size_t>(i)];
      c += 2.0 / n * p.*value * std::cos(kTwoPi * order * p.phase);
      s += 2.0 / n * p.*value * std::sin(kTwoPi * order * p.phase);
    }
    list.push_back(
        {.order = static_cast<double>(order), .amplitude = std::hypot(c, s), .phase = std::atan2(-s, c)});
  }
  return list;
}

double MeshCycle::windup(const GearPair& pair, int gear) {
  const ToothContour& c = pair.contour(gear);
  const double held = pair.held_radius(gear), nu = pair.gear(gear).material.poisson_ratio;
  return c.base_radius() * c.base_radius() * (1.0 + nu) / kTwoPi *
         std::abs(1.0 / (held * held) - 1.0 / (c.root_radius() * c.root_radius()));
}

}  // namespace drev
