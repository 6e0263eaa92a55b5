#include "models/shafts/whole_shaft.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <numbers>

#include "models/shafts/contour_parts.hpp"
#include "solvers/fields/scalar_field.hpp"
#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/modes/lanczos.hpp"

namespace drev {

WholeShaft whole_shaft(const ShaftContour& contour, int halvings) {
  std::vector<Finding> findings;
  ParameterCheck check("shaft", findings);
  check.within("halvings", halvings, 0, 8, "");
  const std::vector<StationSection> sections = check_contour(contour, check);
  if (!findings.empty()) throw ModelError(findings);
  const ContourParts parts(contour, sections, ContourVariant::likely);
  const RevolvedMesh grid = RevolvedMesher(parts.pieces()).mesh(halvings);
  const FieldUnknowns unknowns = field_unknowns(grid.mesh, std::vector<bool>(grid.mesh.nodes.size(), false));
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const auto cube = [](const PlanePoint& p) { return p[1] * p[1] * p[1]; };
  FieldMatrices matrices = assemble_field(
      grid.mesh, unknowns,
      [&](const PlanePoint& p) {
        return kTurn * contour.shear_modulus * parts.section_at(p[0]).factor * cube(p);
      },
      {}, [&](const PlanePoint& p) { return kTurn * contour.density * cube(p); });
  WholeShaft shaft;
  shaft.stiffness = std::move(matrices.stiffness);
  shaft.mass = std::move(matrices.mass);
  shaft.wave_speed = torsional_wave_speed(contour.shear_modulus, contour.density);
  for (const ShaftStation& s : contour.stations) shaft.length += s.length;
  return shaft;
}

double whole_shaft_shift(const WholeShaft& shaft) {
  const double first = std::numbers::pi * shaft.wave_speed / shaft.length;
  return -first * first;
}

WholeShaftModes whole_shaft_modes(const WholeShaft& shaft, int count) {
  const SparseMatrix& k = shaft.stiffness;
  const double sigma = whole_shaft_shift(shaft);
  const Vector shifted = Eigen::Map<const Vector>(k.valuePtr(), k.nonZeros()) - sigma * shaft.mass;
  SparseCholesky factor(k);
  if (factor.factorize(k, shifted) != FactorStatus::success)
    throw SolverError(std::string("modes of a whole shaft: K - sigma M is ") + to_text(factor.status()));
  const Eigen::Map<const SparseMatrix> mass(k.rows(), k.cols(), k.nonZeros(), k.outerIndexPtr(),
                                            k.innerIndexPtr(), shaft.mass.data());
  const auto n = static_cast<Eigen::Index>(k.rows());
  Vector right(n), left(n);
  ShiftInvertProblem problem;
  problem.size = static_cast<int>(n);
  problem.count = count + 1;  // the rigid one with them
  problem.sigma = sigma;
  problem.solve = [&](const double* b, double* x) {
    right = Eigen::Map<const Vector>(b, n);
    factor.solve(right, left);
    Eigen::Map<Vector>(x, n) = left;
  };
  problem.mass = [&](const double* x, double* y) {
    Eigen::Map<Vector>(y, n).noalias() = mass * Eigen::Map<const Vector>(x, n);
  };
  const ShiftInvertResult found = ShiftInvertLanczos(problem).values(count + 1, 1e-9);
  if (found.status != ArpackStatus::success) throw SolverError("modes of a whole shaft: " + found.reason);
  WholeShaftModes modes;
  modes.unknowns = problem.size;
  modes.solves = found.solves;
  for (Eigen::Index i = 1; i < found.lambda.size() && i <= count; ++i)
    modes.frequency_Hz.push_back(std::sqrt(found.lambda[i]) / (2.0 * std::numbers::pi));
  return modes;
}

}  // namespace drev
