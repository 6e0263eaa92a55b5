#include "app/variants/variant_points.hpp"

#include <algorithm>

#include "app/results/hdf5_file.hpp"
#include "app/variants/quasi_random.hpp"
#include "app/variants/variant_table.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kMostNames = 12;

/// The chosen rows, ascending; all rows if there are no more than kMostPoints.
std::vector<std::uint64_t> chosen_rows(std::uint64_t rows) {
  const std::uint64_t count = std::min(rows, kMostPoints);
  std::vector<std::uint64_t> chosen;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t first = i * rows / count, end = (i + 1) * rows / count;
    chosen.push_back(first + hashed(i, rows) % (end - first));
  }
  return chosen;
}

Json list_of_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

}  // namespace

Json variant_points(const VariantStudy& study, const std::string& folder) {
  const std::vector<std::uint64_t> rows = chosen_rows(study.plan().count());
  std::vector<ParameterValues> values;
  for (const std::uint64_t row : rows) values.push_back(study.plan().parameters(row));
  Json points{{"count", rows.size()}, {"of", study.plan().count()}};
  points["parameters"] = Json::array();
  for (std::size_t p = 0; p < study.plan().varied().size(); ++p) {
    const Varied& varied = study.plan().varied()[p];
    Json object{{"name", varied.name}, {"unit", unit_of(study, varied.name)}};
    Json column = Json::array();
    if (text_size(varied) == 0) {
      object["names"] = nullptr;
      for (const ParameterValues& of_row : values) {
        double value = 0.0;
        column.push_back(read_number(of_row[p].second, value) ? number(value) : Json());
      }
    } else {
      const bool few = varied.kind == Varied::Kind::values && varied.values.size() <= kMostNames;
      object["names"] = few ? Json(varied.values) : Json::array();
      for (const ParameterValues& of_row : values)
        if (few)
          column.push_back(
              1 + std::distance(varied.values.begin(),
                                std::find(varied.values.begin(), varied.values.end(), of_row[p].second)));
    }
    object["values"] = std::move(column);
    points["parameters"].push_back(std::move(object));
  }
  points["figures"] = Json::array();
  for (const FigureColumn& figure : study.figures())
    points["figures"].push_back(
        {{"name", figure.name},
         {"unit", figure.unit},
         {"values", list_of_numbers(hdf5_numbers(table_path(folder), figure.name, rows))}});
  return points;
}

}  // namespace drev::app
