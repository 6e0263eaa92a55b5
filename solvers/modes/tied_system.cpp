#include "solvers/modes/tied_system.hpp"

#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/ritz_projection.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

std::optional<TiedSystem> tied_system(const System& system) {
  const auto rigid = [](const FrictionTerm& term) { return term.friction->rigid(); };
  constexpr double kNothing = 1e-12;  // largest entry of a tie that is eliminated already
  const auto row_of = [&](const FrictionTerm& term) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(system.size());
    for (const Entry& e : term.nodes)
      for (const Entry& z : system.row_of(e.index)) row[z.index] += e.coeff * z.coeff;
    return row;
  };
  if (std::none_of(system.frictions().begin(), system.frictions().end(), [&](const FrictionTerm& term) {
        return rigid(term) && row_of(term).lpNorm<Eigen::Infinity>() > kNothing;
      }))
    return std::nullopt;
  if (system.rows().rows() > 0)
    throw SolverError(
        system.name() +
        ": modes of a model with both lossy gears and planetary sets or in reduced coordinates are not "
        "found; put ideal gears in place of the lossy ones");
  const int n = system.size();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(n, n);
  std::vector<char> dependent(idx(n), 0);
  for (const FrictionTerm& term : system.frictions()) {
    if (!rigid(term)) continue;
    const Eigen::RowVectorXd row = row_of(term) * basis;
    Eigen::Index pivot = 0;
    row.cwiseAbs().maxCoeff(&pivot);
    if (row[pivot] == 0.0) continue;
    const Eigen::VectorXd column = basis.col(pivot);
    basis -= column * row / row[pivot];
    basis.col(pivot).setZero();
    dependent[static_cast<std::size_t>(pivot)] = 1;
  }
  std::vector<Eigen::Index> free;
  for (int k = 0; k < n; ++k)
    if (!dependent[idx(k)]) free.push_back(k);
  const Eigen::MatrixXd columns = basis(Eigen::all, free);
  return TiedSystem{ritz_projection(system, columns), columns};
}

}  // namespace drev
