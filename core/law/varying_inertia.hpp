#pragma once
/// VaryingInertia: what a Load may say besides: the inertia that its node has at an angle beyond the constant one in the
/// mass matrix.
///
///   (J + dJ(theta)) theta'' = what else acts on the node, the load's torque -1/2 dJ'(theta) theta'^2 among it
///
/// theta: the node's actual angle, theta'' its actual acceleration. The term of dJ' is the load's own torque. With R the
/// rest of the node's equation, which is J theta'' alone in its row of the mass matrix, this is
///
///   J theta'' = R + (D - 1) R,   D = J/(J + dJ)
///
/// so that (D - 1) R stands as a torque of angle and speed beside a constant mass matrix, without an approximation. The
/// assembler adds it to the right side. Methods in steps and statics take it; exact propagation, lockstep, projections
/// and methods in the frequency domain do not.

namespace drev {

class VaryingInertia {
 public:
  virtual ~VaryingInertia() = default;
  /// False: there is none, and nothing else here is asked.
  virtual bool inertia_varies() const = 0;
  /// dJ at the node's actual angle [rad] -> kg m^2; of period 2 pi, with J + dJ > 0.
  virtual double inertia_beyond(double angle) const = 0;
};

}  // namespace drev
