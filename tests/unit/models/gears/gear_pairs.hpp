#pragma once
/// The pairs that tests and benchmarks compute: the source's two meshes (T1 with its tips cut to what the flanks allow),
/// T1n without shifts, ROSS's 62/62 and a pair with shifts +0.5 and -0.5. ISO 53 A, steel.
#include <drev/models/gears/gear_geometry.hpp>

namespace drev::gear_pairs {

inline GearGeometry pair(double module_mm, int z_1, int z_2, double x_1, double x_2,
                         double tip_alteration = 0.0, double centre_distance = kNotGiven) {
  GearGeometry p;
  p.module = module_mm * 1e-3;
  p.centre_distance = centre_distance;
  p.gear_1.teeth = z_1;
  p.gear_2.teeth = z_2;
  p.gear_1.profile_shift = x_1;
  p.gear_2.profile_shift = x_2;
  for (GearData* g : {&p.gear_1, &p.gear_2}) {
    g->tip_alteration = tip_alteration;
    g->width = 0.1;
    g->bore_diameter = 0.5 * p.module * (g->teeth + 2.0 * g->profile_shift - 2.5);  // half the root circle
  }
  return p;
}
inline GearGeometry t1(double a = kNotGiven) { return pair(8, 59, 68, -0.626, -0.626, -0.26, a); }
inline GearGeometry t1n() { return pair(8, 59, 68, 0, 0); }
inline GearGeometry t2(double a = kNotGiven) {
  GearGeometry p = pair(9, 34, 59, -0.082, -0.082, 0.0, a);
  p.gear_1.width = p.gear_2.width = 0.13;
  return p;
}
inline GearGeometry r62() {
  GearGeometry p = pair(2, 62, 62, 0, 0);
  p.gear_1.material.youngs_modulus = p.gear_2.material.youngs_modulus = 206e9;
  return p;
}
inline GearGeometry s() { return pair(4, 20, 40, 0.5, -0.5); }
inline GearGeometry helical() {
  GearGeometry p = pair(4, 25, 50, 0.2, -0.2);
  p.helix_angle = 0.3;
  return p;
}

}  // namespace drev::gear_pairs
