#include "models/gears/tooth_sector.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace drev {
namespace {

/// A curve by its arc length, tabulated: place(0) to place(1) with nodes at equal lengths.
class ContourCurve {
 public:
  explicit ContourCurve(std::function<PlanePoint(double)> place) : place_(std::move(place)) {
    lengths_.push_back(0.0);
    PlanePoint last = place_(0.0);
    for (int i = 1; i <= kSteps; ++i) {
      const PlanePoint next = place_(static_cast<double>(i) / kSteps);
      lengths_.push_back(lengths_.back() + std::hypot(next[0] - last[0], next[1] - last[1]));
      last = next;
    }
  }
  double length() const { return lengths_.back(); }
  double parameter(double part) const {
    const double wanted = std::clamp(part, 0.0, 1.0) * length();
    const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, wanted);
    const double low = *(above - 1), step = *above - low;
    return (static_cast<double>(above - 1 - lengths_.begin()) + (step > 0.0 ? (wanted - low) / step : 0.0)) /
           kSteps;
  }
  PlanePoint at(double part) const { return place_(parameter(part)); }

 private:
  static constexpr int kSteps = 64;
  std::function<PlanePoint(double)> place_;
  std::vector<double> lengths_;
};

/// Nodes of `elements` quadratic elements on a curve; the first is left out where the line goes on.
void lay(std::vector<PlanePoint>& line, const ContourCurve& curve, int elements) {
  for (int i = line.empty() ? 0 : 1; i <= 2 * elements; ++i) line.push_back(curve.at(0.5 * i / elements));
}

/// Where each point of a line stands, as a part of the line's length.
std::vector<double> parts(const std::vector<PlanePoint>& line) {
  std::vector<double> sum{0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    sum.push_back(sum.back() + std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]));
  for (double& s : sum) s /= sum.back() > 0.0 ? sum.back() : 1.0;
  return sum;
}

PlanePoint between(PlanePoint a, PlanePoint b, double part) {
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
}

/// Transfinite interpolation (Gordon & Hall 1973) at node (i, j) of a block from its four sides.
struct Sides {
  std::vector<PlanePoint> bottom, top, left, right;
  std::vector<double> across, up;  // parts of the sides that stand at node i, j

  PlanePoint at(std::size_t i, std::size_t j) const {
    const double s = across[i], t = up[j];
    PlanePoint p;
    for (std::size_t d = 0; d < 2; ++d) {
      p[d] = (1.0 - s) * left[j][d] + s * right[j][d] + (1.0 - t) * bottom[i][d] + t * top[i][d] -
             (1.0 - s) * ((1.0 - t) * bottom.front()[d] + t * top.front()[d]) -
             s * ((1.0 - t) * bottom.back()[d] + t * top.back()[d]);
    }
    return p;
  }
};

struct HalfSector {
  Sides tooth, foot, rim;
  std::vector<PlaneMaterial> rim_material;  // by row
  std::vector<double> flank_lengths;
  int fillet_rows = 0, flank_rows = 0;
};

std::vector<double> even(int elements) {
  std::vector<double> list;
  for (int i = 0; i <= 2 * elements; ++i) list.push_back(0.5 * i / elements);
  return list;
}

/// Heights of the rim's nodes from the bore up to `top`, rows growing downwards; the web begins and ends between rows.
void lay_rim(HalfSector& half, const GearData& g, double module, double bore, double top, int level,
             std::vector<double>& heights) {
  constexpr double kFirst = 0.7, kGrowth = 1.7;
  std::vector<double> ends{bore, top};
  const bool web = !std::isnan(g.web_thickness);
  if (web) ends = {bore, 0.5 * g.hub_diameter / module, 0.5 * g.rim_inner_diameter / module, top};
  heights = {bore};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double depth = ends[k + 1] - ends[k], from = kFirst + (kGrowth - 1.0) * (top - ends[k + 1]);
    const int rows =
        level * std::max(1, static_cast<int>(
                                std::ceil(std::log1p(depth * (kGrowth - 1.0) / from) / std::log(kGrowth))));
    const double ratio = std::log1p(depth * (kGrowth - 1.0) / from);
    for (int i = 2 * rows - 1; i >= 0; --i)
      heights.push_back(ends[k + 1] - depth * std::expm1(ratio * 0.5 * i / rows) / std::expm1(ratio));
    const bool thin = web && k == 1;
    half.rim_material.insert(half.rim_material.end(), static_cast<std::size_t>(rows),
                             {.poisson_ratio = g.material.poisson_ratio,
                              .thickness = thin ? g.web_thickness / g.width : 1.0,
                              .plane_stress = thin});
  }
}

HalfSector half_sector(const GearPair& pair, int gear, int level) {
  const ToothContour& c = pair.contour(gear);
  const GearData& g = pair.gear(gear);
  const double m = c.data().module, to = ToothContour::kQuarterTurn, half_pitch = kPi / c.data().teeth;
  // Heights on the tooth's centre line: radii, of a ring less than 0.
  const double side = c.side();
  const auto scaled = [m, side](const ToothContour::Place& p) {
    return PlanePoint{p.x() / m, side * p.y() / m};
  };
  const auto turned = [](double height, double angle) {
    return PlanePoint{std::abs(height) * std::sin(angle), height * std::cos(angle)};
  };
  const std::string name = "gear_" + std::to_string(gear + 1);
  const double corner = c.data().pressure_angle + 0.4 * (to - c.data().pressure_angle);
  const PlanePoint b = scaled(c.fillet(corner));
  const bool web = !std::isnan(g.web_thickness);
  const double bore = side * pair.held_radius(gear) / m, floor = web ? 0.5 * g.rim_inner_diameter / m : bore;
  const double centre = std::max(b[1] - b[0], floor + 0.35 * (b[1] - floor));
  if (b[1] - centre < 0.3 * b[0]) {
    const char* key = pair.is_ring(gear) ? "outer_diameter" : web ? "rim_inner_diameter" : "bore_diameter";
    throw ModelError({{name, key, to_text(2.0 * m * std::abs(floor)), "m",
                       std::string("leaves too thin a rim for the tooth; at ") +
                           (pair.is_ring(gear) ? "least " : "most ") +
                           to_text(2.0 * m * std::abs(b[1] - 0.3 * b[0] / 0.65))}});
  }
  const int depth = 2 * level;
  HalfSector half;
  // The contour from B up to the tip, and down to the middle of the space.
  half.fillet_rows = level;
  half.flank_rows = 3 * level;
  const auto fillet = [&](double from, double until) {
    return ContourCurve([&, from, until](double s) { return scaled(c.fillet(from + s * (until - from))); });
  };
  const double low = c.form_length(), high = c.tip_length();
  const ContourCurve flank([&](double s) { return scaled(c.flank(low + s * (high - low))); });
  lay(half.tooth.right, fillet(corner, c.data().pressure_angle), half.fillet_rows);
  lay(half.tooth.right, flank, half.flank_rows);
  for (int i = 0; i <= half.flank_rows; ++i)
    half.flank_lengths.push_back(
        (low + flank.parameter(static_cast<double>(i) / half.flank_rows) * (high - low)) / m);
  const double tip = c.data().tip_radius, tip_angle = c.tip_half_angle();
  int rows = half.fillet_rows + half.flank_rows;
  if (c.data().chamfer > 0.0) {
    const PlanePoint from = half.tooth.right.back(), until = scaled({tip, tip_angle});
    lay(half.tooth.right, ContourCurve([&](double s) { return between(from, until, s); }), level);
    rows += level;
  }
  const ContourCurve lower = fillet(corner, to);
  const double root_from = c.root_angle(), root_length = (half_pitch - root_from) * c.root_radius() / m;
  const int columns = 3 * level;
  const int on_root = std::clamp(
      static_cast<int>(std::lround(columns * root_length / (root_length + lower.length()))), 0, columns - 1);
  const ContourCurve root([&](double s) {
    return scaled({c.root_radius(), root_from + s * (half_pitch - root_from)});
  });
  if (on_root > 0) {
    lay(half.foot.top, lower, columns - on_root);
    lay(half.foot.top, root, on_root);
  } else {
    const double split = lower.length() / (lower.length() + std::max(root_length, 0.0));
    lay(half.foot.top, ContourCurve([&](double s) {
          return s < split ? lower.at(s / split) : root.at(split < 1.0 ? (s - split) / (1.0 - split) : 1.0);
        }),
        columns);
  }
  // Lines inside.
  half.tooth.up = parts(half.tooth.right);
  half.tooth.across = half.foot.up = even(depth);
  const PlanePoint d{0.0, centre}, crown{0.0, side * tip / m};
  for (const double s : half.tooth.across) {
    half.tooth.bottom.push_back(between(d, b, s));
    half.tooth.top.push_back(scaled({tip, s * tip_angle}));
    half.foot.right.push_back(between(turned(centre, half_pitch), half.foot.top.back(), s));
  }
  half.foot.left = half.tooth.bottom;
  for (const double s : half.tooth.up) half.tooth.left.push_back(between(d, crown, s));
  half.foot.across = half.rim.across = parts(half.foot.top);
  std::vector<double> heights;
  lay_rim(half, g, m, bore, centre, level, heights);
  const auto circle = [&](double height) {
    std::vector<PlanePoint> line;
    for (const double s : half.foot.across) line.push_back(turned(height, s * half_pitch));
    return line;
  };
  half.foot.bottom = half.rim.top = circle(centre);
  half.rim.bottom = circle(bore);
  for (const double h : heights) {
    half.rim.up.push_back((h - bore) / (centre - bore));
    half.rim.left.push_back({0.0, h});
    half.rim.right.push_back(turned(h, half_pitch));
  }
  return half;
}

/// Adds a block and, for side = -1, its mirror image; gives node (i, j) of the half as it stands there.
struct Block {
  std::vector<int> nodes;
  std::size_t columns, rows;
  bool mirrored;
  int operator()(std::size_t i, std::size_t j) const {
    return nodes[j * (2 * columns + 1) + (mirrored ? 2 * columns - i : i)];
  }
};

Block add(QuadraticMesh& mesh, const Sides& sides, bool mirrored) {
  const std::size_t columns = (sides.across.size() - 1) / 2, rows = (sides.up.size() - 1) / 2;
  const bool polar =
      sides.left.front()[0] == 0.0 && sides.left.back()[0] == 0.0 && sides.bottom.front()[0] == 0.0 &&
      std::abs(sides.bottom.back()[0] * sides.top.back()[1] - sides.bottom.back()[1] * sides.top.back()[0]) <
          1e-9 * std::abs(sides.top.back()[1]);
  auto nodes = add_block(mesh, static_cast<int>(columns), static_cast<int>(rows), [&](double s, double t) {
    const auto i =
        static_cast<std::size_t>(std::lround(2.0 * static_cast<double>(columns) * (mirrored ? 1.0 - s : s)));
    const auto j = static_cast<std::size_t>(std::lround(2.0 * static_cast<double>(rows) * t));
    PlanePoint p;
    if (polar) {  // rings, so that the mesh is the body's own
      const double radius = std::abs(sides.left[j][1]),
                   scale = radius / std::hypot(sides.top[i][0], sides.top[i][1]);
      p = {sides.top[i][0] * scale, sides.top[i][1] * scale};
    } else {
      p = sides.at(i, j);
    }
    return mirrored ? PlanePoint{-p[0], p[1]} : p;
  });
  return {std::move(nodes), columns, rows, mirrored};
}

}  // namespace

ToothSector tooth_sector(const GearPair& pair, int gear, int level) {
  const HalfSector half = half_sector(pair, gear, level);
  ToothSector sector;
  std::vector<Block> tooth, foot, rim;
  const PlaneMaterial whole{.poisson_ratio = pair.gear(gear).material.poisson_ratio};
  for (const bool mirrored : {false, true}) {
    tooth.push_back(add(sector.mesh, half.tooth, mirrored));
    foot.push_back(add(sector.mesh, half.foot, mirrored));
    sector.material.resize(sector.mesh.cells.size(), whole);
    rim.push_back(add(sector.mesh, half.rim, mirrored));
    for (const PlaneMaterial& row : half.rim_material)
      sector.material.insert(sector.material.end(), rim.back().columns, row);
  }
  const std::vector<int> joined = join_nodes(sector.mesh, 1e-6);
  const auto node = [&](const Block& block, std::size_t i, std::size_t j) {
    return joined[static_cast<std::size_t>(block(i, j))];
  };
  for (std::size_t side = 0; side < 2; ++side) {
    const bool mirrored = side == 1;
    const auto edge = [&](int a, int b, int c) {
      const ToothSector::Edge on_right{a, b, c}, on_left{c, b, a};
      sector.edges.push_back(mirrored ? on_left : on_right);
    };
    const Block &t = tooth[side], &f = foot[side], &r = rim[side];
    std::vector<int>& border = mirrored ? sector.left : sector.right;
    for (std::size_t j = 0; j + 2 <= 2 * t.rows; j += 2) {
      edge(node(t, 2 * t.columns, j), node(t, 2 * t.columns, j + 1), node(t, 2 * t.columns, j + 2));
      const auto row = static_cast<int>(j / 2) - half.fillet_rows;
      if (!mirrored && row >= 0 && row < half.flank_rows) sector.flank.push_back(sector.edges.back());
    }
    for (std::size_t i = 0; i + 2 <= 2 * t.columns; i += 2)
      edge(node(t, i + 2, 2 * t.rows), node(t, i + 1, 2 * t.rows), node(t, i, 2 * t.rows));
    for (std::size_t i = 0; i + 2 <= 2 * f.columns; i += 2)
      edge(node(f, i + 2, 2 * f.rows), node(f, i + 1, 2 * f.rows), node(f, i, 2 * f.rows));
    for (std::size_t j = 0; j + 2 <= 2 * f.rows; j += 2)
      edge(node(f, 2 * f.columns, j), node(f, 2 * f.columns, j + 1), node(f, 2 * f.columns, j + 2));
    for (std::size_t j = 0; j + 2 <= 2 * r.rows; j += 2)
      edge(node(r, 2 * r.columns, j), node(r, 2 * r.columns, j + 1), node(r, 2 * r.columns, j + 2));
    for (std::size_t j = 2 * f.rows; j > 0; --j) border.push_back(node(f, 2 * f.columns, j));
    for (std::size_t j = 2 * r.rows; j > 0; --j) border.push_back(node(r, 2 * r.columns, j));
    for (std::size_t i = 0; i <= 2 * r.columns; ++i) sector.bore.push_back(node(r, i, 0));
  }
  sector.flank_lengths = half.flank_lengths;
  return sector;
}

}  // namespace drev
