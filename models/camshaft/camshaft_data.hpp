#pragma once
/// The camshaft's data. NOT the builder's: the source (S. L. Sunde, NTNU, 2015) prints its results but not
/// its inertias, stiffnesses and cam torques. They were reconstructed by fitting what it does print:
///   - inertias and stiffnesses (data/camshaft.toml) to the 20 free-free frequencies of Tables 5.1 to 5.4
///     (mode 5 of 9 cylinders with its misprint corrected): rms error 0.42 %, largest 0.95 %;
///   - cam torques (data/cam_torque.csv) to the 24 transient results of Tables 5.5 to 5.8, integrated at
///     the source's step of 1 ms: rms error about 20 %.
#include <drev/elements/periodic_table.hpp>

#include <string>
#include <vector>

namespace drev {

/// From data/camshaft.toml, which is a model file, too.
struct CamshaftData {
  double gear_inertia, journal_inertia, fuel_inertia, exhaust_inertia, inlet_inertia;  // kg m^2
  double gear_stiffness, journal_stiffness, fuel_stiffness, exhaust_stiffness,
      inlet_stiffness;  // N m/rad
};
const CamshaftData& camshaft_data();

/// Inertia of the free end [kg m^2] for 6 to 10 cylinders; that for 10 is the mean of 6, 7 and 9.
double camshaft_end_inertia(int cylinders);

/// Torques of the three cams over one camshaft revolution, rad -> N m, on the right-hand side.
struct CamTorques {
  PeriodicTable fuel, exhaust, inlet;
};
const CamTorques& cam_torques();

/// Firing order of the source for 6, 8 and 9 cylinders; 7 and 10 (not printed there) are common orders of
/// engines of that size.
std::vector<int> default_firing_order(int cylinders);

/// C = a M + b K.
struct RayleighCase {
  double a = 0.0;  ///< 1/s
  double b = 0.0;  ///< s
};
/// undamped; case_1 (a alone), case_2 (b alone) for xi_1 = 0.01 of Table 3.2; case_3 of Table 3.3 as printed
/// (hertz and rad/s mixed: a 2 pi too large, b 2 pi too small); case_3_corrected, which gives xi_1 = 0.01 and
/// xi_2 = 0.02 at the printed frequencies. Throws ModelError for another name.
RayleighCase rayleigh_case(const std::string& name, int cylinders);

}  // namespace drev
