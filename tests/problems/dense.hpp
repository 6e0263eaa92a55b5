#pragma once
/// A system's values on its pattern as a dense matrix, read entry by entry.
#include <drev/core/assembler.hpp>

#include <Eigen/Dense>

namespace drev::problems {

inline Eigen::MatrixXd dense(const System& system, const Vector& values) {
  const SparseMatrix& p = system.pattern();
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(p.rows(), p.cols());
  for (int col = 0; col < p.cols(); ++col)
    for (int s = p.outerIndexPtr()[col]; s < p.outerIndexPtr()[col + 1]; ++s)
      m(p.innerIndexPtr()[s], col) = values[s];
  return m;
}

/// K z + C v + laws + general elements - loads: everything but the inertia.
inline Vector forces(const Assembler& assembler, const Vector& z, const Vector& v, const Vector& history) {
  const System& system = assembler.system();
  Vector f = dense(system, system.stiffness_values()) * z + dense(system, system.damping_values()) * v;
  Vector p, history_new(history.size());
  assembler.add_scalar_forces(z, v, f);
  assembler.add_general_forces(z, v, history, f, history_new);
  assembler.external(z, v, p);
  return f - p;
}

}  // namespace drev::problems
