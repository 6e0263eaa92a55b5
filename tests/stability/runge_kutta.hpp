#pragma once
/// Classical Runge-Kutta of fourth order over a System's own terms: an independent integration to
/// compare with. Knows nothing of pieces or knots; small steps resolve them.
#include <drev/core/assembler.hpp>

/// Advances the state to t_end in steps of at most h. M must be diagonal.
inline void runge_kutta(const drev::System& system, double t_end, double h, drev::State& s) {
  using drev::Vector;
  drev::Assembler assembler(system);
  const int n = system.size();
  Vector mass(n), force(n), scratch(n);
  for (int i = 0; i < n; ++i)
    mass[i] = system.mass_values()[system.diagonal_slots()[static_cast<std::size_t>(i)]];
  const auto acceleration = [&](double t, const Vector& z, const Vector& v) {
    assembler.set_time(t);
    assembler.external(z, v, force);
    assembler.multiply_stiffness(z, scratch);
    force -= scratch;
    assembler.multiply_damping(v, scratch);
    force -= scratch;
    scratch.setZero();
    assembler.add_scalar_forces(z, v, scratch);
    return Vector((force - scratch).cwiseQuotient(mass));
  };
  const double start = s.t;
  const long steps = static_cast<long>(std::ceil((t_end - start) / h - 1e-9));
  h = (t_end - start) / static_cast<double>(steps);
  for (long i = 0; i < steps; ++i) {
    const double t = start + static_cast<double>(i) * h;
    const Vector v1 = s.v, a1 = acceleration(t, s.z, v1);
    const Vector v2 = s.v + 0.5 * h * a1, a2 = acceleration(t + 0.5 * h, s.z + 0.5 * h * v1, v2);
    const Vector v3 = s.v + 0.5 * h * a2, a3 = acceleration(t + 0.5 * h, s.z + 0.5 * h * v2, v3);
    const Vector v4 = s.v + h * a3, a4 = acceleration(t + h, s.z + h * v3, v4);
    s.z += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    s.v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  s.t = t_end;
}
