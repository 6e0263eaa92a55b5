#include "models/camshaft/camshaft_data.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/rayleigh_damping.hpp>
#include <drev/models/parameters.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string_view>

namespace drev::data {
extern const std::string_view camshaft_cam_torque;  // models/camshaft/data/cam_torque.csv
extern const std::string_view camshaft_camshaft;    // models/camshaft/data/camshaft.toml
}  // namespace drev::data

namespace drev {

namespace {

constexpr int kFewest = 6;

/// The lines "name = number" and "name = [number, ...]" of camshaft.toml.
std::map<std::string, std::vector<double>> read_numbers() {
  std::map<std::string, std::vector<double>> all;
  std::string_view rest = data::camshaft_camshaft;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t equals = line.find(" = ");
    if (equals == line.npos || line.starts_with('#')) continue;
    std::string values(line.substr(equals + 3));
    values.resize(std::min(values.find(" #"), values.size()));
    for (char& c : values)
      if (c == '[' || c == ']' || c == ',') c = ' ';
    std::istringstream words(values);
    std::vector<double> numbers;
    double value = 0.0;
    for (std::string word; words >> word && read_number(word, value);) numbers.push_back(value);
    if (!numbers.empty()) all.emplace(line.substr(0, equals), std::move(numbers));
  }
  return all;
}

const std::vector<double>& numbers(const std::string& name) {
  static const std::map<std::string, std::vector<double>> all = read_numbers();
  const auto found = all.find(name);
  if (found == all.end()) throw ModelError({{"camshaft.toml", name, "", "", "is missing"}});
  return found->second;
}

std::size_t row(int cylinders) {
  if (cylinders < kFewest || cylinders > kFewest + 4)
    throw ModelError({{"camshaft", "cylinders", std::to_string(cylinders), "", "must be between 6 and 10"}});
  return static_cast<std::size_t>(cylinders - kFewest);
}

/// Of a list with a number for each count of cylinders.
double number(const std::string& name, int cylinders) { return numbers(name).at(row(cylinders)); }

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
        throw ModelError(
            {{"cam_torque.csv", "row", std::to_string(columns[0].size() + 2), "", "must hold four numbers"}});
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

const CamshaftData& camshaft_data() {
  const auto inertia = [](const std::string& of) { return numbers(of + "_inertia_kg_m2").front(); };
  const auto stiffness = [](const std::string& of) { return numbers(of + "_stiffness_Nm_per_rad").front(); };
  static const CamshaftData data{.gear_inertia = inertia("gear"),
                                 .journal_inertia = inertia("journal"),
                                 .fuel_inertia = inertia("fuel"),
                                 .exhaust_inertia = inertia("exhaust"),
                                 .inlet_inertia = inertia("inlet"),
                                 .gear_stiffness = stiffness("gear"),
                                 .journal_stiffness = stiffness("journal"),
                                 .fuel_stiffness = stiffness("fuel"),
                                 .exhaust_stiffness = stiffness("exhaust"),
                                 .inlet_stiffness = stiffness("inlet")};
  return data;
}

double camshaft_end_inertia(int cylinders) { return number("end_inertia_kg_m2", cylinders); }

const CamTorques& cam_torques() {
  static const CamTorques torques = read_cam_torques();
  return torques;
}

std::vector<int> default_firing_order(int cylinders) {
  row(cylinders);
  const std::vector<double>& order = numbers("firing_order_" + std::to_string(cylinders));
  return {order.begin(), order.end()};
}

RayleighCase rayleigh_case(const std::string& name, int cylinders) {
  if (name == "undamped") return {};
  if (name == "case_1") return {number("case_1_a_per_s", cylinders), 0.0};
  if (name == "case_2") return {0.0, number("case_2_b_s", cylinders)};
  if (name == "case_3") return {number("case_3_a_per_s", cylinders), number("case_3_b_s", cylinders)};
  if (name == "case_3_corrected") {
    const auto ab = RayleighDamping::from_two_modes(number("omega_1_rad_per_s", cylinders), 0.01,
                                                    number("omega_2_rad_per_s", cylinders), 0.02);
    return {ab.alpha_mass, ab.beta_stiffness};
  }
  throw ModelError({{"camshaft", "damping", name, "", "is no damping case"}});
}

}  // namespace drev
