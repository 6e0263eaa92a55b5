#include "solvers/periodic/floquet.hpp"

#include <drev/core/assembler.hpp>

#include <Eigen/Cholesky>
#include <cmath>
#include <map>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "core/dense_eigen.hpp"

namespace drev {

namespace {

Eigen::MatrixXd dense(const Assembler& assembler, const Weights& weights) {
  SparseMatrix matrix = assembler.system().pattern();
  Vector values(matrix.nonZeros());
  assembler.linear_values(weights, values);
  Eigen::Map<Vector>(matrix.valuePtr(), matrix.nonZeros()) = values;
  return Eigen::MatrixXd(matrix);
}

}  // namespace

double largest_floquet_exponent(const System& system, double period, int pieces) {
  Assembler assembler(system);
  const Eigen::Index n = system.size();
  const Eigen::MatrixXd stiffness = dense(assembler, {.k = 1.0});
  const auto mass = dense(assembler, {.m = 1.0}).llt();
  const Eigen::MatrixXd drag = mass.solve(dense(assembler, {.c = 1.0}));
  // Rates in units of a frequency of the train, so that z and v/w are of one size.
  const double w = std::sqrt(mass.solve(stiffness).cwiseAbs().rowwise().sum().maxCoeff());
  const Vector rest = Vector::Zero(n);
  std::map<std::vector<double>, Eigen::MatrixXd> turns;  // by the meshes' stiffnesses
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (int p = 0; p < pieces; ++p) {
    assembler.set_time((p + 0.5) * period / pieces);
    std::vector<double> slopes;
    Eigen::MatrixXd k = stiffness;
    for (const ScalarTerm& term : system.scalars()) {
      slopes.push_back(assembler.respond(term, rest, rest).dy_dx);
      for (const drev::Entry& a : term.z)
        for (const drev::Entry& b : term.z) k(a.index, b.index) += slopes.back() * a.coeff * b.coeff;
    }
    auto found = turns.find(slopes);
    if (found == turns.end()) {
      Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      rates.topRightCorner(n, n).diagonal().setConstant(w);
      rates.bottomLeftCorner(n, n) = -mass.solve(k) / w;
      rates.bottomRightCorner(n, n) = -drag;
      found = turns.emplace(slopes, (rates * (period / pieces)).exp()).first;
    }
    product = found->second * product;
  }
  return std::log(spectral_radius(product)) / period;
}

}  // namespace drev
