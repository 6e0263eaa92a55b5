#pragma once
#include <drev/core/lanes.hpp>

namespace drev {

/// The motion at the end of a step, in lanes: z = z_0 + kappa_z a, v = v_0 + kappa_v a.
struct LaneMotion {
  const LaneRow *z_0, *v_0, *a;
  double kappa_z, kappa_v;
  double z(int i, int lane) const { return z_0[i].v[lane] + kappa_z * a[i].v[lane]; }
  double v(int i, int lane) const { return v_0[i].v[lane] + kappa_v * a[i].v[lane]; }
};

}  // namespace drev
