#pragma once
/// A system in other coordinates, or in fewer: z = basis y (Ritz).
///
///   (B'MB) y'' + (B'CB) y' + (B'KB) y + sum_j (B'b_j) y_j(x_j, x_j', t) = B' p(t, B y) - ...
///
/// It has the nodes, elements and channels of the system that it is made of, and serves every solver but
/// lockstep. Laws and loads see the motion B y and keep their own form; whatever force is normal to B's
/// columns is left out, so that an ideal gear's torque, the rest of a balance of forces at a node, is
/// approximate.
/// Entries of the projected matrices below the rounding of their own sum are zero. Initial conditions are
/// those nearest in kinetic energy.
#include <drev/core/system.hpp>

namespace drev {

/// basis: one row for each unknown of the system, columns linearly independent. Throws ModelError where it is
/// not so, and where a node of a general element does not keep a coordinate of its own (a row of the basis
/// with one entry).
System ritz_projection(const System& system, const Eigen::MatrixXd& basis);

}  // namespace drev
