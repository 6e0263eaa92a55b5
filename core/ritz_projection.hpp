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

/// The system with those unknowns at rest that `held` marks, one flag each, and with values added to its damping and its stiffness
/// [on System::pattern(); empty: none]. No law, load or frequency term acts on a held one; their nodes have the deviation 0. It has no
/// frequency terms: what is added stands for them. Sparse systems stay so.
System held_system(const System& system, const std::vector<bool>& held, const Vector& damping,
                   const Vector& stiffness);

}  // namespace drev
