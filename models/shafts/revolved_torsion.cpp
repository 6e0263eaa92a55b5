#include "models/shafts/revolved_torsion.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "solvers/fields/scalar_field.hpp"

namespace drev {
namespace {

struct RevolvedResult {
  double flexibility = 0.0;
  std::vector<double> spans, peak, peak_at;
  int unknowns = 0;
};

/// J over that of the round section at z.
class SectionFactor {
 public:
  explicit SectionFactor(const std::vector<RevolvedStation>& stations) {
    double z = 0.0;
    for (const RevolvedStation& s : stations) ends_.push_back(z += s.length), factors_.push_back(s.factor);
    plain_ = std::all_of(factors_.begin(), factors_.end(), [](double f) { return f == 1.0; });
  }
  double at(double z) const {
    if (plain_) return 1.0;
    const auto k = std::lower_bound(ends_.begin(), ends_.end() - 1, z) - ends_.begin();
    return factors_[static_cast<std::size_t>(k)];
  }

 private:
  std::vector<double> ends_, factors_;
  bool plain_ = true;
};

/// Where along v of a column of cells a plane divides it.
double division(const RevolvedMesh& grid, std::size_t column, double plane) {
  const double* place = &grid.place[2 * column];
  const int half = plane > place[1] ? 1 : 0;
  return half - 1.0 + (plane - place[half]) / (place[half + 1] - place[half]);
}

/// The integral of a function of points over a cell from v = from to v = to.
template <class Function>
double integral(const QuadraticMesh& mesh, int cell, double from, double to, const Function& f) {
  static const double place = std::sqrt(0.6);
  static const double at[] = {-place, 0.0, place}, weight[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  const double half = 0.5 * (to - from);
  double sum = 0.0;
  for (int k = 0; k < 9; ++k) {
    const CellPoint point = cell_point(mesh, cell, at[k % 3], from + half * (1.0 + at[k / 3]));
    sum += weight[k % 3] * weight[k / 3] * half * point.jacobian * f(point);
  }
  return sum;
}

RevolvedResult solve_once(const std::vector<RevolvedStation>& stations, const RevolvedMesh& grid,
                          const std::vector<double>& planes) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const QuadraticMesh& mesh = grid.mesh;
  const auto width = static_cast<std::size_t>(2 * grid.rows + 1);
  const SectionFactor factor(stations);
  // The left end is held, the right end turns as a whole: one unknown, the last, with the load T = 2 pi G.
  FieldUnknowns unknowns;
  const std::size_t last = mesh.nodes.size() - width;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
    unknowns.of_node.push_back(node < width ? -1 : static_cast<int>(std::min(node, last) - width));
  unknowns.count = static_cast<int>(last - width) + 1;
  const auto conductivity = [&](const PlanePoint& p) { return factor.at(p[0]) * p[1] * p[1] * p[1]; };
  FieldMatrices matrices = assemble_field(mesh, unknowns, conductivity, {});
  matrices.load[unknowns.count - 1] = 1.0;
  const std::vector<double> theta = solve_field(matrices, unknowns);
  RevolvedResult found;
  found.unknowns = unknowns.count;
  found.flexibility = theta.back() / kTurn;
  found.spans.assign(planes.size() + 1, 0.0);
  found.peak.assign(stations.size(), 0.0);
  found.peak_at.assign(stations.size(), 0.0);
  for (int column = 0; column < grid.columns; ++column) {
    const auto c = static_cast<std::size_t>(column);
    const auto first = std::upper_bound(planes.begin(), planes.end(), grid.place[2 * c]);
    const auto span = static_cast<std::size_t>(first - planes.begin());
    std::vector<double> ends{-1.0};  // of the spans in this column
    for (auto plane = first; plane != planes.end() && *plane < grid.place[2 * c + 2]; ++plane)
      ends.push_back(division(grid, c, *plane));
    ends.push_back(1.0);
    for (int row = 0; row < grid.rows; ++row) {
      const int cell = column * grid.rows + row;
      const auto energy = [&](double from, double to) {
        return integral(mesh, cell, from, to, [&](const CellPoint& point) {
          const PlanePoint g = field_gradient(mesh, cell, point, theta);
          return conductivity(point.position) * (g[0] * g[0] + g[1] * g[1]) / kTurn;
        });
      };
      std::vector<double> parts;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) parts.push_back(energy(ends[k], ends[k + 1]));
      // Rules over parts are not quite the rule over the cell, whose sum is the work of the torque.
      const double scale =
          parts.size() == 1 ? 1.0 : energy(-1.0, 1.0) / std::accumulate(parts.begin(), parts.end(), 0.0);
      for (std::size_t k = 0; k < parts.size(); ++k) found.spans[span + k] += scale * parts[k];
    }
    if (grid.station[c] < 0) continue;
    const auto station = static_cast<std::size_t>(grid.station[c]);
    for (const double v : {-1.0, 0.0, 1.0}) {
      const CellPoint point = cell_point(mesh, column * grid.rows, -1.0, v);
      if (!(point.jacobian > 0.0)) continue;
      const PlanePoint g = field_gradient(mesh, column * grid.rows, point, theta);
      const double stress = std::hypot(g[0], g[1]) * point.position[1] / kTurn;
      if (stress > found.peak[station])
        found.peak[station] = stress, found.peak_at[station] = point.position[0];
    }
  }
  return found;
}

}  // namespace

namespace {

RevolvedTorsion refine(const std::vector<RevolvedStation>& stations, const std::vector<double>& planes,
                       const RevolvedOptions& options, const RevolvedMesher& mesher) {
  const auto solve = [&](int halvings) { return solve_once(stations, mesher.mesh(halvings), planes); };
  RevolvedResult coarse = solve(0);
  double change_before = 0.0;
  for (int halvings = 1;; ++halvings) {
    RevolvedResult fine = solve(halvings);
    RevolvedTorsion found;
    found.unknowns = fine.unknowns;
    const double change = fine.flexibility - coarse.flexibility;
    if (change_before != 0.0 && change != 0.0) found.order = std::log2(std::abs(change_before / change));
    // Smooth contours converge with the fourth power of the size of cells, sharp corners with 4/3: the rest of the
    // change is between 1/15 and 0.66 of the last one.
    const double rest =
        found.order > 0.0 ? 1.0 / (std::exp2(std::clamp(found.order, 1.0, 4.0)) - 1.0) : 1.0 / 15.0;
    found.flexibility = {fine.flexibility + rest * change, std::max(rest, 0.5) * std::abs(change),
                         Estimate::Kind::estimate};
    for (std::size_t k = 0; k < fine.spans.size(); ++k) {
      const double more = fine.spans[k] - coarse.spans[k];
      found.spans.push_back(
          {fine.spans[k] + rest * more, std::max(rest, 0.5) * std::abs(more), Estimate::Kind::estimate});
    }
    bool good = found.flexibility.error <= options.accuracy * found.flexibility.value;
    for (std::size_t k = 0; k < stations.size(); ++k) {
      const double more = fine.peak[k] - coarse.peak[k];
      found.peak.push_back({fine.peak[k] + more / 3.0, std::abs(more) / 2.0, Estimate::Kind::estimate});
      if (!options.judge.empty() && options.judge[k])
        good = good && found.peak[k].error <= 10.0 * options.accuracy * found.peak[k].value;
    }
    found.peak_at = fine.peak_at;
    if (good || mesher.nodes(halvings + 1) > options.largest) return found;
    coarse = std::move(fine);
    change_before = change;
  }
}

}  // namespace

RevolvedTorsion solve_revolved(const std::vector<RevolvedStation>& stations,
                               const std::vector<double>& planes, const RevolvedOptions& options) {
  // Columns that lean less are worse cells at faces, but fit where steps are close to each other; bent ones are better
  // and more often possible where the bore has steps.
  constexpr double kLeast = 0.05;
  const bool stepped = std::any_of(stations.begin(), stations.end(),
                                   [&](const RevolvedStation& s) { return s.bore != stations.front().bore; });
  for (double lean = 1.0;; lean *= 0.4)
    for (const bool bent : {stepped, !stepped}) {
      try {
        return refine(stations, planes, options, RevolvedMesher(stations, lean, bent));
      } catch (const SolverError&) {
        if (bent != stepped && lean < kLeast) throw;
      }
    }
}

}  // namespace drev
