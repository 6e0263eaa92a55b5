#include "models/shafts/section_torsion.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/fields/graded_division.hpp"
#include "solvers/fields/scalar_field.hpp"

namespace drev {
namespace {

PlanePoint minus(const PlanePoint& a, const PlanePoint& b) { return {a[0] - b[0], a[1] - b[1]}; }
double cross(const PlanePoint& a, const PlanePoint& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Cells along the outline, as parameters of their edges.
struct OutlineCells {
  std::vector<const OutlineEdge*> edge;  // of each cell
  std::vector<double> from, to;          // of each cell, over its edge
  double smallest = 0.0;                 // size [unit of the outline]
  std::size_t count() const { return edge.size(); }
};

double edge_length(const OutlineEdge& edge) {
  constexpr int kPieces = 64;
  double length = 0.0;
  for (int i = 0; i < kPieces; ++i) {
    const PlanePoint step = minus(edge.at((i + 1.0) / kPieces), edge.at(double(i) / kPieces));
    length += std::hypot(step[0], step[1]);
  }
  return length;
}

OutlineCells outline_cells(const SectionOutline& outline) {
  OutlineCells cells;
  const double largest =
      outline.size * outline.copies > 2.0 * outline.size ? 0.1 * outline.size : 0.15 * outline.size;
  const std::size_t n = outline.edges.size();
  std::vector<double> lengths, round;  // size of the cells of a round; 0: no round
  for (const OutlineEdge& edge : outline.edges) {
    lengths.push_back(edge_length(edge));
    round.push_back(edge.cells > 0 ? lengths.back() / edge.cells : 0.0);
  }
  cells.smallest = largest;
  for (std::size_t k = 0; k < n; ++k) {
    const OutlineEdge& edge = outline.edges[k];
    const double before = round[(k + n - 1) % n], after = round[(k + 1) % n];
    std::vector<double> ends;
    if (edge.cells > 0) {
      for (int i = 0; i <= edge.cells; ++i) ends.push_back(double(i) / edge.cells);
    } else {
      const double most = std::min(largest, lengths[k] / 4.0);
      ends = graded_division(lengths[k], {.first = before > 0.0 ? before : most,
                                          .last = after > 0.0 ? after : most,
                                          .growth = 0.5,
                                          .largest = most});
    }
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      cells.edge.push_back(&edge);
      cells.from.push_back(ends[i]);
      cells.to.push_back(ends[i + 1]);
      cells.smallest = std::min(cells.smallest, lengths[k] * (ends[i + 1] - ends[i]));
    }
  }
  return cells;
}

/// The least sine of the angle between the outline and the line to the pole; < 0 where the pole does not see it.
double visibility(const OutlineCells& cells, const PlanePoint& pole) {
  double least = 1.0;
  for (std::size_t k = 0; k < cells.count(); ++k) {
    constexpr double kIn = 1e-3;
    for (const double part : {0.0, 1.0}) {
      const double width = cells.to[k] - cells.from[k];
      const PlanePoint here = cells.edge[k]->at(cells.from[k] + part * width);
      const PlanePoint near = cells.edge[k]->at(cells.from[k] + (part == 0.0 ? kIn : 1.0 - kIn) * width);
      const PlanePoint along = part == 0.0 ? minus(near, here) : minus(here, near), ray = minus(here, pole);
      const double size = std::hypot(along[0], along[1]) * std::hypot(ray[0], ray[1]);
      least = std::min(least, size > 0.0 ? cross(ray, along) / size : -1.0);
    }
  }
  return least;
}

PlanePoint best_pole(const SectionOutline& outline, const OutlineCells& cells) {
  PlanePoint low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (std::size_t k = 0; k < cells.count(); ++k) {
    const PlanePoint p = cells.edge[k]->at(cells.from[k]);
    for (std::size_t d = 0; d < 2; ++d) low[d] = std::min(low[d], p[d]), high[d] = std::max(high[d], p[d]);
  }
  PlanePoint best{};
  double seen = -1.0;
  constexpr int kGrid = 12;
  PlanePoint middle{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
  PlanePoint step{(high[0] - low[0]) / kGrid, (high[1] - low[1]) / kGrid};
  for (int round = 0; round < 3; ++round, middle = best, step = {step[0] / 4.0, step[1] / 4.0}) {
    for (int i = 0; i <= kGrid * kGrid + 2 * kGrid; ++i) {
      const PlanePoint pole{middle[0] + step[0] * (i % (kGrid + 1) - kGrid / 2),
                            middle[1] + step[1] * (i / (kGrid + 1) - kGrid / 2)};
      const double v = visibility(cells, pole);
      if (v > seen) seen = v, best = pole;
    }
  }
  if (seen < 0.02)
    throw ModelError({{outline.name, "outline", "", "",
                       "must be visible from one point inside it: dimensions do not fit together"}});
  return best;
}

struct Solved {
  double constant = 0.0, peak = 0.0, area = 0.0, polar = 0.0;
  PlanePoint peak_at{}, centroid{};
  int unknowns = 0;
};

class SectionFan {
 public:
  SectionFan(const SectionOutline& outline) : outline_(outline), cells_(outline_cells(outline)) {
    if (hollow()) {
      if (visibility(cells_, outline.hole) < 0.02)
        throw ModelError({{outline.name, "outline", "", "", "must be visible from the middle of its hole"}});
    } else {
      pole_ = best_pole(outline, cells_);
    }
    double longest = 0.0;
    for (std::size_t k = 0; k < cells_.count(); ++k)
      longest = std::max(longest, ray(cells_.edge[k]->at(cells_.from[k])));
    // Layers of the fan from the pole or hole, thinnest at the outline.
    const double first = std::min(0.125, cells_.smallest / longest);
    layers_ = graded_division(
        1.0,
        {.first = hollow() ? std::max(first, 0.0625) : 0.2, .last = first, .growth = 0.4, .largest = 0.2});
  }

  /// halvings: every cell of the first mesh is cut into 2^halvings by 2^halvings.
  Solved solve(int halvings) const;
  int unknowns(int halvings) const {
    return 4 * static_cast<int>(cells_.count() * (layers_.size() - 1)) << (2 * halvings);
  }

 private:
  bool hollow() const { return outline_.hole_radius > 0.0; }
  double ray(const PlanePoint& p) const {
    const PlanePoint r = minus(p, hollow() ? outline_.hole : pole_);
    return std::hypot(r[0], r[1]) - outline_.hole_radius;
  }
  PlanePoint at(double s, const PlanePoint& rim) const {
    if (!hollow()) return {pole_[0] + s * (rim[0] - pole_[0]), pole_[1] + s * (rim[1] - pole_[1])};
    const PlanePoint r = minus(rim, outline_.hole);
    const double length = std::hypot(r[0], r[1]);
    const double part = (outline_.hole_radius * (1.0 - s) + length * s) / length;
    return {outline_.hole[0] + part * r[0], outline_.hole[1] + part * r[1]};
  }
  static double part_of(const std::vector<double>& ends, double t, int cells) {
    const double at = t * cells;
    const int cell = std::min(static_cast<int>(at * (1.0 + 1e-12)), cells - 1);
    const int per = cells / (static_cast<int>(ends.size()) - 1);
    const auto k = static_cast<std::size_t>(cell / per);
    return ends[k] + (ends[k + 1] - ends[k]) * (at / per - double(k));
  }

  const SectionOutline& outline_;
  OutlineCells cells_;
  PlanePoint pole_{};
  std::vector<double> layers_;
};

Solved SectionFan::solve(int halvings) const {
  const int finer = 1 << halvings, rows = static_cast<int>(cells_.count()) * finer;
  const int columns = static_cast<int>(layers_.size() - 1) * finer;
  // Points of the outline at every half cell.
  std::vector<PlanePoint> rim;
  for (int j = 0; j <= 2 * rows; ++j) {
    const int cell = std::min(j / (2 * finer), static_cast<int>(cells_.count()) - 1);
    const auto k = static_cast<std::size_t>(cell);
    const double part = (0.5 * j / finer) - cell;
    rim.push_back(cells_.edge[k]->at(cells_.from[k] + (cells_.to[k] - cells_.from[k]) * part));
  }
  QuadraticMesh mesh;
  add_block(mesh, columns, rows, [&](double s, double t) {
    return at(part_of(layers_, s, columns), rim[static_cast<std::size_t>(std::lround(2.0 * rows * t))]);
  });
  // psi = 0 on free edges; one value at the pole or on the hole; the outline ends where it began.
  const int width = 2 * columns + 1;
  FieldUnknowns unknowns;
  unknowns.of_node.assign(mesh.nodes.size(), -2);
  unknowns.count = 1;  // the first is that of the pole or hole
  for (int j = 0; j <= 2 * rows; ++j) {
    for (int i = 0; i < width; ++i) {
      const auto node = static_cast<std::size_t>(j * width + i);
      const auto before = static_cast<std::size_t>(std::max(0, (j - 1) / (2 * finer)));
      const auto behind =
          static_cast<std::size_t>(std::min(j / (2 * finer), static_cast<int>(cells_.count()) - 1));
      if (i == 0)
        unknowns.of_node[node] = 0;
      else if (i == width - 1 && (cells_.edge[before]->free || cells_.edge[behind]->free))
        unknowns.of_node[node] = -1;
      else if (j == 2 * rows)
        unknowns.of_node[node] = unknowns.of_node[static_cast<std::size_t>(i)];
      else
        unknowns.of_node[node] = unknowns.count++;
    }
  }
  FieldMatrices matrices = assemble_field(
      mesh, unknowns, [](const PlanePoint&) { return 1.0; }, [](const PlanePoint&) { return 2.0; });
  if (hollow()) matrices.load[0] += 2.0 * std::numbers::pi * outline_.hole_radius * outline_.hole_radius;
  const std::vector<double> psi = solve_field(matrices, unknowns);
  Solved found;
  found.unknowns = unknowns.count;
  for (std::size_t node = 0; node < psi.size(); ++node) {
    // Shared unknowns count once: the load already sums their shares.
    const int u = unknowns.of_node[node];
    const bool first = u > 0 ? node < static_cast<std::size_t>(2 * rows * width) : node == 0;
    if (u >= 0 && first) found.constant += psi[node] * matrices.load[u];
  }
  found.constant *= outline_.copies;
  for (int cell = 0; cell < columns * rows; ++cell) {
    for (const CellPoint& point : gauss_points(mesh, cell)) {
      found.area += outline_.copies * point.weight;
      found.polar += outline_.copies * point.weight *
                     (point.position[0] * point.position[0] + point.position[1] * point.position[1]);
      for (const std::size_t d : {0U, 1U}) found.centroid[d] += point.weight * point.position[d];
    }
    const bool rim_cell = cell % columns == columns - 1, hole_cell = hollow() && cell % columns == 0;
    const auto k = static_cast<std::size_t>(cell / columns / finer);
    const auto look = [&](double u) {
      for (const double v : {-1.0, 0.0, 1.0}) {
        const CellPoint point = cell_point(mesh, cell, u, v);
        const PlanePoint g = field_gradient(mesh, cell, point, psi);
        const double stress = std::hypot(g[0], g[1]);
        if (stress > found.peak) found.peak = stress, found.peak_at = point.position;
      }
    };
    if (rim_cell && cells_.edge[k]->free) look(1.0);
    if (hole_cell) look(-1.0);
  }
  return found;
}

}  // namespace

SectionTorsion solve_section(const SectionOutline& outline, double accuracy) {
  std::vector<Finding> findings;
  ParameterCheck(outline.name, findings).within("accuracy", accuracy, 1e-7, 0.1, "");
  if (!findings.empty()) throw ModelError(findings);
  const SectionFan fan(outline);
  Solved coarse = fan.solve(0);
  for (int halvings = 1;; ++halvings) {
    const Solved fine = fan.solve(halvings);
    SectionTorsion found;
    // J converges with the fourth power of the size of the cells, stresses on the outline with the second.
    const double change = fine.constant - coarse.constant, more = fine.peak - coarse.peak;
    found.constant = {fine.constant + change / 15.0, std::abs(change) / 4.0, Estimate::Kind::estimate};
    found.peak_stress = {fine.peak + more / 3.0, std::abs(more) / 2.0, Estimate::Kind::estimate};
    found.peak_at = fine.peak_at;
    found.area = fine.area;
    found.polar = fine.polar;
    const bool whole = outline.copies == 1;
    found.centroid = {whole ? fine.centroid[0] / fine.area : NAN, whole ? fine.centroid[1] / fine.area : NAN};
    found.unknowns = fine.unknowns;
    const bool good = found.constant.error <= accuracy * found.constant.value &&
                      found.peak_stress.error <= 10.0 * accuracy * found.peak_stress.value;
    if (good || fan.unknowns(halvings + 1) > kLargestSection) return found;
    coarse = fine;
  }
}

}  // namespace drev
