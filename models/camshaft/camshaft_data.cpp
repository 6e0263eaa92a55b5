#include <array>
#include <string_view>

#include "core/units.hpp"
#include "elements/rayleigh_damping.hpp"
#include "models/camshaft/camshaft_data.hpp"
#include "models/settings.hpp"

namespace drev::data {
extern const std::string_view camshaft_cam_torque;  // models/camshaft/data/cam_torque.csv
}

namespace drev {

namespace {

struct PrintedDamping {
  double case_1_a, case_2_b;              // Table 3.2: 1/s, s
  double case_3_a, case_3_b;              // Table 3.3: 1/s, s
  double omega_1, omega_2;                // Table 3.3: rad/s
};

constexpr int kFewest = 6;
constexpr std::array<PrintedDamping, 5> kPrinted{{{21.16, 1.89e-5, 29.69, 2.35e-6, 1046.6, 2579.7},
                                                  {18.74, 2.13e-5, 24.48, 2.72e-6, 925.5, 2242.8},
                                                  {16.88, 2.37e-5, 22.00, 2.95e-6, 859.9, 2068.0},
                                                  {15.38, 2.60e-5, 17.54, 3.43e-6, 757.6, 1784.8},
                                                  {14.16, 2.83e-5, 15.60, 3.67e-6, 719.0, 1672.0}}};
constexpr std::array<double, 5> kEndInertia{0.4382, 0.3015, 0.04305, 0.2854, 0.3417};

std::size_t row(int cylinders) {
  if (cylinders < kFewest || cylinders > kFewest + 4)
    throw ModelError({{"camshaft", "cylinders", std::to_string(cylinders), "",
                       "must be between 6 and 10"}});
  return static_cast<std::size_t>(cylinders - kFewest);
}

/// Columns angle_deg, fuel, exhaust, inlet; the row at 360 deg repeats the one at 0 and is left out.
CamTorques read_cam_torques() {
  std::array<std::vector<double>, 4> columns;
  const std::string_view all = data::camshaft_cam_torque;
  std::size_t begin = all.find('\n') + 1;
  while (begin < all.size()) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    std::string_view line = all.substr(begin, end - begin);
    begin = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::size_t comma = std::min(line.find(','), line.size());
      double value = 0.0;
      if (!read_number(std::string(line.substr(0, comma)), value))
        throw ModelError({{"cam_torque.csv", "row", std::to_string(columns[0].size() + 2), "",
                           "must hold four numbers"}});
      columns[c].push_back(value);
      line.remove_prefix(std::min(comma + 1, line.size()));
    }
  }
  if (!columns[0].empty() && columns[0].back() >= 360.0)
    for (auto& column : columns) column.pop_back();
  for (double& angle : columns[0]) angle = deg(angle);
  return {PeriodicTable(columns[0], columns[1]), PeriodicTable(columns[0], columns[2]),
          PeriodicTable(columns[0], columns[3])};
}

}  // namespace

double camshaft_end_inertia(int cylinders) { return kEndInertia[row(cylinders)]; }

const CamTorques& cam_torques() {
  static const CamTorques torques = read_cam_torques();
  return torques;
}

std::vector<int> default_firing_order(int cylinders) {
  row(cylinders);
  switch (cylinders) {
    case 6: return {1, 5, 3, 6, 2, 4};
    case 7: return {1, 3, 5, 7, 6, 4, 2};
    case 8: return {1, 8, 7, 2, 6, 5, 4, 3};
    case 9: return {1, 4, 8, 2, 6, 9, 3, 5, 7};
    default: return {1, 6, 2, 8, 4, 10, 5, 9, 3, 7};
  }
}

RayleighCase rayleigh_case(const std::string& name, int cylinders) {
  const PrintedDamping& p = kPrinted[row(cylinders)];
  if (name == "undamped") return {};
  if (name == "case_1") return {p.case_1_a, 0.0};
  if (name == "case_2") return {0.0, p.case_2_b};
  if (name == "case_3") return {p.case_3_a, p.case_3_b};
  if (name == "case_3_corrected") {
    const auto ab = RayleighDamping::from_two_modes(p.omega_1, 0.01, p.omega_2, 0.02);
    return {ab.alpha_mass, ab.beta_stiffness};
  }
  throw ModelError({{"camshaft", "damping", name, "", "is no damping case"}});
}

}  // namespace drev
