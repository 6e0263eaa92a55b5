#pragma once
/// Results that the source prints (S. L. Sunde, Mechanical analysis of camshaft system on a marine engine,
/// NTNU, 2015), as printed; its misprints are named where they are used. drev's beside them: docs/study.md.
#include <array>

namespace drev::published {

inline constexpr double kStep = 1e-3;     ///< s, of every run in time
inline constexpr double kDuration = 5.0;  ///< s
inline constexpr double kEngineRpm = 750;

/// Tables 5.1 to 5.4: torsional frequencies [Hz] of the free camshaft, multibody and finite elements.
struct FreeModes {
  int cylinders;
  const char* table;
  std::array<double, 5> mbs, fem;
};
inline constexpr std::array<FreeModes, 4> kFreeModes{
    {{6, "5.1", {167.10, 412.70, 659.60, 886.00, 1075.30}, {166.57, 410.23, 658.61, 890.43, 1085.60}},
     {7, "5.2", {149.71, 361.48, 584.16, 800.53, 996.76}, {147.30, 356.95, 573.81, 782.14, 971.07}},
     {8, "5.3", {138.20, 331.56, 535.70, 737.20, 927.68}, {136.86, 329.13, 530.64, 730.20, 918.00}},
     {9, "5.4", {122.66, 287.15, 461.77, 635.45, 788.97}, {120.58, 284.06, 456.11, 626.09, 802.28}}}};

/// Figure 5.10, section 6.2: read off the spectrum of a history [Hz].
inline constexpr double kHeldFirst8 = 102.39;

/// Tables 3.2 and 3.3: C = a M + b K, a [1/s], b [s]; frequencies [rad/s].
struct Rayleigh {
  int cylinders;
  double case_1_a, case_2_b, omega_1, omega_2, case_3_a, case_3_b;
};
inline constexpr std::array<Rayleigh, 5> kRayleigh{{{6, 21.16, 1.89e-5, 1046.6, 2579.7, 29.69, 2.35e-6},
                                                    {7, 18.74, 2.13e-5, 925.5, 2242.8, 24.48, 2.72e-6},
                                                    {8, 16.88, 2.37e-5, 859.9, 2068.0, 22.00, 2.95e-6},
                                                    {9, 15.38, 2.60e-5, 757.6, 1784.8, 17.54, 3.43e-6},
                                                    {10, 14.16, 2.83e-5, 719.0, 1672.0, 15.60, 3.67e-6}}};

/// Table 4.1, from the crankshaft to the camshaft: module and base diameter [mm].
struct Gear {
  const char* name;
  double module;
  int teeth;
  double base_diameter;
};
inline constexpr std::array<Gear, 4> kGears{{{"crankshaft", 8, 59, 443.535},
                                             {"big idler", 8, 64, 511.193},
                                             {"small idler", 9, 34, 287.546},
                                             {"camshaft", 9, 59, 498.977}}};
inline constexpr double kPressureAngleDeg = 20;

/// One pair of mesh 1 and 2 by cantilever beams, equation 4.14 with the source's dimensions [N/m].
inline constexpr std::array<double, 2> kCantilever{3.72e8, 1.48e9};

/// Table 4.2: moment [N m] on the pinion, tooth deflection [m], stiffness [N/m].
struct MeshStiffness {
  const char* name;
  double moment, deflection, stiffness;
  int pinion;  ///< of kGears
};
inline constexpr std::array<MeshStiffness, 4> kMeshStiffness{
    {{"mesh 1, one pair of teeth", 867.7, 5.944e-6, 6.185e8, 0},
     {"mesh 1, two pairs", 867.6, 3.550e-6, 1.035e9, 0},
     {"mesh 2, one pair", 576.3, 5.207e-6, 7.234e8, 2},
     {"mesh 2, two pairs", 576.0, 4.681e-6, 8.042e8, 2}}};

/// Tables 5.5 to 5.8: undamped, damping cases 1 to 3. Deflections [deg]; torque of the undamped run [N m].
struct Transient {
  int cylinders;
  const char* table;
  std::array<double, 4> deflection, amplification;
  double torque;
  int iterations;
};
inline constexpr std::array<Transient, 3> kTransient{
    {{6, "5.7", {0.636, 0.353, 0.370, 0.360}, {1.615, 1.196, 1.296, 1.048}, 2.139e4, 17231},
     {8, "5.6", {8.623, 2.486, 3.193, 2.131}, {7.338, 4.786, 5.766, 4.237}, 9.753e4, 20302},
     {9, "5.5", {1.913, 0.999, 1.023, 0.946}, {3.482, 2.437, 2.864, 2.323}, 4.721e4, 18937}}};

/// Tables 5.9 and 5.10: torque [N m], deflection [deg]. The damping is not printed.
struct FiringOrder {
  const char* order;
  double torque, deflection;
};
inline constexpr std::array<FiringOrder, 4> kOrders6{{{"1-5-3-6-2-4", 1.787e4, 0.366},
                                                      {"1-4-3-6-2-5", 1.675e4, 0.376},
                                                      {"1-2-3-4-5-6", 2.223e4, 0.549},
                                                      {"1-6-2-5-3-4", 1.862e4, 0.488}}};
inline constexpr std::array<FiringOrder, 4> kOrders8{{{"1-8-7-2-6-5-4-3", 5.448e4, 2.059},
                                                      {"1-5-4-8-7-2-6-3", 4.772e4, 2.043},
                                                      {"1-2-7-8-4-5-6-3", 5.019e4, 2.059},
                                                      {"1-5-3-7-4-8-2-6", 5.207e4, 2.383}}};

/// Tables 5.11, 5.12: 9 cylinders with gear drive, 0.15 mm in both meshes; deflection [deg], torque [N m].
struct GearDrive {
  const char* table;
  int front, back, iterations;
  double deflection, torque;
};
inline constexpr std::array<GearDrive, 2> kGearDrive{
    {{"5.11", 2327, 2284, 20977, 2.602, 1.847e5}, {"5.12", 2139, 2049, 21141, 1.186, 5.620e4}}};

/// Table 5.13: backlash [mm], deflection [deg].
struct Backlash {
  double gap, deflection;
};
inline constexpr std::array<Backlash, 7> kBacklash{{{0.05, 1.092},
                                                    {0.15, 1.185},
                                                    {0.25, 1.467},
                                                    {0.30, 1.838},
                                                    {0.35, 1.479},
                                                    {0.43, 2.016},
                                                    {0.50, 2.411}}};

/// Table 5.14: 9 cylinders, case 1, no backlash; constant and varying stiffness.
struct Stiffness {
  int iterations;
  double deflection, torque;
};
inline constexpr std::array<Stiffness, 2> kStiffness{{{14596, 1.0433, 1.585e4}, {14594, 1.0494, 1.615e4}}};

}  // namespace drev::published
