#include "models/shafts/revolved_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/fields/graded_division.hpp"

namespace drev {
namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr double kReachGrowth = 0.7;  // of the length l of columns with the distance from a corner

/// A stretch of the surface or bore between two steps; height is r of the surface, -r of the bore.
struct Plateau {
  double from, to, left, right;    // z, heights
  double round_left, round_right;  // radii of rounds that lie on it
  double wall;                     // thickness of the material
  double lead = 0.0, trail = 0.0;  // what the marks run ahead at its ends
};

/// A round of radius rho takes up all of a step of height h.
bool no_face(double rho, double h) { return h - rho <= 1e-9 * h; }
/// Length along the axis of that round.
double round_extent(double rho, double h) {
  return h >= rho ? rho : std::sqrt(std::max(2.0 * rho * h - h * h, 0.0));
}

PlanePoint towards(const PlanePoint& a, const PlanePoint& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

class ContourBuilder {
 public:
  ContourBuilder(std::vector<Plateau> plateaus, double sign, double lean)
      : plateaus_(std::move(plateaus)), sign_(sign) {
    leads(lean);
    for (std::size_t k = 0; k < plateaus_.size(); ++k) {
      const Plateau& p = plateaus_[k];
      station_ = static_cast<int>(k);
      const double left = rest_left(k), right = rest_right(k);
      const double slope = (p.right - p.left) / (p.to - p.from);
      if (k > 0 && left > 0.0 && drop(k - 1) > 0.0) round(k, false);
      const double z0 = p.from + left, z1 = p.to - right;
      if (z1 - z0 > 1e-12 * (p.to - p.from))
        line({z0, p.left + slope * left}, {z1, p.right - slope * right}, mark_left(k), mark_right(k));
      if (k + 1 < plateaus_.size()) step(k);
    }
  }
  std::vector<ContourEdge> edges;

 private:
  double drop(std::size_t k) const { return plateaus_[k].right - plateaus_[k + 1].left; }
  bool same(std::size_t k) const { return std::abs(drop(k)) <= 1e-9 * std::abs(plateaus_[k].right); }
  double rest_left(std::size_t k) const {
    if (k == 0 || same(k - 1) || drop(k - 1) < 0.0) return 0.0;
    return round_extent(plateaus_[k].round_left, drop(k - 1));
  }
  double rest_right(std::size_t k) const {
    if (k + 1 == plateaus_.size() || same(k) || drop(k) > 0.0) return 0.0;
    return round_extent(plateaus_[k].round_right, -drop(k));
  }
  /// Marks run ahead on the higher side of a step, by half of what lies below it, and half of the step.
  void leads(double lean) {
    for (std::size_t k = 0; k < plateaus_.size(); ++k) {
      Plateau& p = plateaus_[k];
      const bool up = k > 0 && !same(k - 1) && drop(k - 1) < 0.0;
      const bool down = k + 1 < plateaus_.size() && !same(k) && drop(k) > 0.0;
      const double flat = p.to - p.from - rest_left(k) - rest_right(k);
      const double room = lean * (up && down ? 0.42 : 0.8) * flat;
      if (up) p.lead = std::min(room, 0.5 * lean * (plateaus_[k - 1].wall - drop(k - 1)));
      if (down) p.trail = std::min(room, 0.5 * lean * (plateaus_[k + 1].wall + drop(k)));
    }
  }
  double mark_left(std::size_t k) const {
    const Plateau& p = plateaus_[k];
    if (k > 0 && !same(k - 1) && drop(k - 1) > 0.0 && p.round_left <= 0.0) return p.from - low_mark(k - 1);
    return p.from + rest_left(k) + p.lead;
  }
  double mark_right(std::size_t k) const {
    const Plateau& p = plateaus_[k];
    if (k + 1 < plateaus_.size() && !same(k) && drop(k) < 0.0 && p.round_right <= 0.0)
      return p.to + low_mark(k);
    return p.to - rest_right(k) - p.trail;
  }
  /// How far the mark at the foot of the step behind plateau k is ahead.
  double low_mark(std::size_t k) const {
    const double h = std::abs(drop(k)), wall = drop(k) > 0.0 ? plateaus_[k + 1].wall : plateaus_[k].wall;
    const double all = drop(k) > 0.0 ? plateaus_[k].trail : plateaus_[k + 1].lead;
    return all * wall / (wall + h);
  }
  void step(std::size_t k) {
    if (same(k)) return;
    const Plateau &p = plateaus_[k], &next = plateaus_[k + 1];
    const double h = std::abs(drop(k)), z = p.to;
    if (drop(k) < 0.0) {
      if (p.round_right > 0.0) round(k, true);
      station_ = static_cast<int>(k) + 1;
      if (!no_face(p.round_right, h))
        line({z, p.right + p.round_right}, {z, next.left}, foot_mark(k), z + next.lead);
    } else {
      if (!no_face(next.round_left, h))
        line({z, p.right}, {z, next.left + next.round_left}, z - p.trail, foot_mark(k));
    }
  }
  /// The mark where the face of a step ends and its round or the lower plateau begins.
  double foot_mark(std::size_t k) const {
    const Plateau &p = plateaus_[k], &next = plateaus_[k + 1];
    const double z = p.to, h = std::abs(drop(k));
    const double rho = drop(k) < 0.0 ? p.round_right : next.round_left;
    if (drop(k) < 0.0) return no_face(rho, h) ? z + next.lead : z + low_mark(k);
    return no_face(rho, h) ? z - p.trail : z - low_mark(k);
  }
  void line(PlanePoint a, PlanePoint b, double mark_from, double mark_to) {
    a[1] *= sign_, b[1] *= sign_;
    edges.push_back({.at = [a, b](double t) { return towards(a, b, t); },
                     .length = std::hypot(b[0] - a[0], b[1] - a[1]),
                     .mark_from = mark_from,
                     .mark_to = mark_to,
                     .station = station_,
                     .face = a[0] == b[0]});
  }
  /// The round on plateau k, at its right end (up) or left end (down).
  void round(std::size_t k, bool up) {
    const Plateau& p = plateaus_[k];
    const double rho = up ? p.round_right : p.round_left, h = std::abs(drop(up ? k : k - 1));
    const double extent = round_extent(rho, h), angle = h >= rho ? kQuarter : std::acos(1.0 - h / rho);
    const double z = up ? p.to - extent : p.from + extent, height = (up ? p.right : p.left) + rho;
    const double sign = sign_;
    edges.push_back({.at =
                         [=](double t) {
                           const double a = angle * (up ? t : t - 1.0);
                           return PlanePoint{z + rho * std::sin(a), sign * (height - rho * std::cos(a))};
                         },
                     .length = rho * angle,
                     .round_cells = std::max(4, static_cast<int>(std::ceil(12.0 * angle / kQuarter))),
                     .round = rho,
                     .mark_from = up ? z : foot_mark(k - 1),
                     .mark_to = up ? foot_mark(k) : z,
                     .station = static_cast<int>(k)});
  }

  std::vector<Plateau> plateaus_;
  double sign_;
  int station_ = 0;
};

PlanePoint inward_normal(const ContourEdge& edge, double t) {
  constexpr double kStep = 1e-4;
  const double a = std::max(t - kStep, 0.0), b = std::min(t + kStep, 1.0);
  const PlanePoint p = edge.at(a), q = edge.at(b);
  const double size = std::hypot(q[0] - p[0], q[1] - p[1]);
  return {(q[1] - p[1]) / size, -(q[0] - p[0]) / size};
}

}  // namespace

RevolvedContour revolved_contour(const std::vector<RevolvedStation>& stations, double lean) {
  std::vector<Plateau> surface, bore;
  double z = 0.0;
  for (const RevolvedStation& s : stations) {
    const double wall = std::min(s.left, s.right) - s.bore;
    surface.push_back({z, z + s.length, s.left, s.right, s.round_left, s.round_right, wall});
    bore.push_back({z, z + s.length, -s.bore, -s.bore, 0.0, 0.0, wall});
    z += s.length;
  }
  return {ContourBuilder(std::move(surface), 1.0, lean).edges,
          ContourBuilder(std::move(bore), -1.0, lean).edges};
}

std::vector<SharpEdge> sharp_edges(const std::vector<RevolvedStation>& stations) {
  // Stress grows as distance^-(turn/pi): by about a hundredth over three decades.
  constexpr double kSmooth = 5e-3;
  const std::vector<ContourEdge> edges = revolved_contour(stations, 1.0).surface;
  std::vector<SharpEdge> found(stations.size(), SharpEdge::none);
  for (std::size_t v = 0; v <= edges.size(); ++v) {
    const ContourEdge &before = edges[v == 0 ? 0 : v - 1], &behind = edges[std::min(v, edges.size() - 1)];
    // An end that turns as a whole is a mirror: a cylinder goes on straight there.
    constexpr PlanePoint kCylinder{0.0, -1.0};
    const PlanePoint a = v == 0 ? kCylinder : inward_normal(before, 1.0),
                     b = v == edges.size() ? kCylinder : inward_normal(behind, 0.0);
    if (std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]) < kSmooth) continue;
    const SharpEdge kind = before.face || behind.face ? SharpEdge::shoulder : SharpEdge::corner;
    for (const ContourEdge* edge : {&before, &behind})
      if (!edge->face) {
        SharpEdge& of_station = found[static_cast<std::size_t>(edge->station)];
        of_station = std::max(of_station, kind);
      }
  }
  return found;
}

RevolvedMesher::RevolvedMesher(const std::vector<RevolvedStation>& stations, double lean, bool bent)
    : contour_(revolved_contour(stations, lean)) {
  double z = 0.0;
  for (std::size_t k = 0; bent && k <= stations.size(); ++k) {
    // Between what the stations on both sides leave.
    const RevolvedStation &left = stations[k == 0 ? 0 : k - 1],
                          &right = stations[std::min(k, stations.size() - 1)];
    const double outer = k == 0                 ? right.left
                         : k == stations.size() ? left.right
                                                : std::min(left.right, right.left);
    middle_.push_back({z, 0.5 * (outer + std::max(left.bore, right.bore))});
    if (k < stations.size()) z += right.length;
  }
  corners(stations);
  divide(stations);
}

void RevolvedMesher::corners(const std::vector<RevolvedStation>& stations) {
  const std::vector<ContourEdge>& edges = contour_.surface;
  const std::size_t n = edges.size();
  double thinnest = 1.0;
  for (std::size_t v = 0; v <= n; ++v) {
    const ContourEdge &before = edges[v == 0 ? 0 : v - 1], &behind = edges[std::min(v, n - 1)];
    const PlanePoint a = inward_normal(before, v == 0 ? 0.0 : 1.0),
                     b = inward_normal(behind, v == n ? 1.0 : 0.0);
    const double turn = a[0] * b[1] - a[1] * b[0];  // sine of the angle by which the contour rises there
    const PlanePoint p = behind.at(v == n ? 1.0 : 0.0);
    const RevolvedStation& s = stations[static_cast<std::size_t>(behind.station)];
    const double wall = std::max(p[1] - s.bore, 1e-3 * p[1]);
    double size = 0.12 * wall, reach = 0.5 * wall;
    if (turn > 0.3) size = 1e-3 * wall, reach = 0.1 * wall;
    for (const ContourEdge* edge : {&before, &behind})
      if (edge->round_cells > 0) {
        size = std::min(size, edge->length / edge->round_cells);
        reach = std::min(reach, 1.5 * edge->round);
      }
    if (v > 0 && v < n && std::abs(turn) > 0.02)
      size = std::min({size, 0.3 * before.length, 0.3 * behind.length});
    corner_size_.push_back(size);
    corner_reach_.push_back(reach);
    thinnest = std::min(thinnest, size / wall);
  }
  // Both grow no faster than with the distance from the next corner.
  const auto even = [&](std::size_t v, std::size_t from, double length) {
    corner_size_[v] = std::min(corner_size_[v], corner_size_[from] + 0.4 * length);
    corner_reach_[v] = std::min(corner_reach_[v], corner_reach_[from] + kReachGrowth * length);
  };
  for (std::size_t v = 1; v <= n; ++v) even(v, v - 1, edges[v - 1].length);
  for (std::size_t v = n; v-- > 0;) even(v, v + 1, edges[v].length);
  const double first = std::clamp(0.6 * std::sqrt(thinnest), 0.01, 0.06);
  layers_ = graded_division(1.0, {.first = first, .last = 0.2, .growth = 0.3, .largest = 0.2});
}

/// Cuts of an edge: its corners and those of the bore.
void RevolvedMesher::divide(const std::vector<RevolvedStation>& stations) {
  struct Cut {
    double at, size;
  };
  for (std::size_t e = 0; e < contour_.surface.size(); ++e) {
    const ContourEdge& edge = contour_.surface[e];
    if (edge.round_cells > 0) {
      for (int i = 0; i < edge.round_cells; ++i)
        cells_.push_back({e, double(i) / edge.round_cells, (i + 1.0) / edge.round_cells});
      continue;
    }
    const RevolvedStation& s = stations[static_cast<std::size_t>(edge.station)];
    std::vector<Cut> cuts{{0.0, corner_size_[e]}};
    for (std::size_t b = 1; b < contour_.bore.size(); ++b) {
      const double t = (contour_.bore[b].mark_from - edge.mark_from) / (edge.mark_to - edge.mark_from);
      if (t > 1e-6 && t < 1.0 - 1e-6) cuts.push_back({t, 0.08 * (std::min(s.left, s.right) - s.bore)});
    }
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.at < b.at; });
    cuts.push_back({1.0, corner_size_[e + 1]});
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      const double part = cuts[c + 1].at - cuts[c].at, length = edge.length * part;
      if (part < 1e-7) continue;
      const std::vector<double> ends = graded_division(
          length, {.first = cuts[c].size, .last = cuts[c + 1].size, .growth = 0.4, .largest = 0.5 * length});
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        cells_.push_back({e, cuts[c].at + part * ends[i], cuts[c].at + part * ends[i + 1]});
    }
  }
}

PlanePoint RevolvedMesher::foot(double mark) const {
  const std::vector<ContourEdge>& bore = contour_.bore;
  auto edge = bore.begin();
  while (edge + 1 != bore.end() && mark > edge->mark_to) ++edge;
  return edge->at(std::clamp((mark - edge->mark_from) / (edge->mark_to - edge->mark_from), 0.0, 1.0));
}

PlanePoint RevolvedMesher::bend(double mark) const {
  auto next = middle_.begin() + 1;
  while (next + 1 != middle_.end() && mark > (*next)[0]) ++next;
  const PlanePoint &a = *(next - 1), &b = *next;
  return {mark, a[1] + (b[1] - a[1]) * (mark - a[0]) / (b[0] - a[0])};
}

/// Of the first mesh, from the surface to the bore.
int RevolvedMesher::rows() const {
  constexpr int kBelow = 6;
  return static_cast<int>(layers_.size() - 1) + (middle_.empty() ? 0 : kBelow);
}

/// l over the length of the column at a place of a cell.
double RevolvedMesher::share(const Cell& cell, double t, double length) const {
  const double along = contour_.surface[cell.edge].length;
  return std::min({corner_reach_[cell.edge] + kReachGrowth * t * along,
                   corner_reach_[cell.edge + 1] + kReachGrowth * (1.0 - t) * along, 0.5 * length}) /
         length;
}

double RevolvedMesher::nodes(int halvings) const {
  return 4.0 * double(cells_.size()) * rows() * std::pow(4.0, halvings);
}

RevolvedMesh RevolvedMesher::mesh(int halvings) const {
  const int finer = 1 << halvings;
  RevolvedMesh made;
  made.columns = static_cast<int>(cells_.size()) * finer;
  made.rows = rows() * finer;
  struct Ray {
    PlanePoint p, f, end;  // f: its foot, or its bend; end: on the bore
    double share;
  };
  std::vector<Ray> rays;
  for (int j = 0; j <= 2 * made.columns; ++j) {
    const auto k = static_cast<std::size_t>(std::min(j / (2 * finer), static_cast<int>(cells_.size()) - 1));
    const Cell& cell = cells_[k];
    const ContourEdge& edge = contour_.surface[cell.edge];
    const double part = 0.5 * j / finer - double(k), t = cell.from + part * (cell.to - cell.from);
    const double mark = edge.mark_from + t * (edge.mark_to - edge.mark_from);
    const PlanePoint p = edge.at(t), end = foot(mark), f = middle_.empty() ? end : bend(mark);
    constexpr double kMean = 0.2;
    made.place.push_back(p[0] + kMean * (mark - p[0]));
    rays.push_back({p, f, end, share(cell, t, std::hypot(f[0] - p[0], f[1] - p[1]))});
    if (j % 2 == 0 && j < 2 * made.columns) made.station.push_back(edge.face ? -1 : edge.station);
  }
  add_block(made.mesh, made.rows, made.columns, [&](double s, double t) {
    const Ray& ray = rays[static_cast<std::size_t>(std::lround(2.0 * made.columns * t))];
    const double at = s * rows(), above = double(layers_.size() - 1);
    if (at > above * (1.0 + 1e-12)) return towards(ray.f, ray.end, (at - above) / (rows() - above));
    const auto k = static_cast<std::size_t>(std::min(at * (1.0 + 1e-12), double(layers_.size() - 2)));
    const double in = layers_[k] + (layers_[k + 1] - layers_[k]) * (at - double(k));
    return towards(ray.p, ray.f, 2.0 * in * (1.0 - in) * ray.share + in * in);
  });
  return made;
}

}  // namespace drev
