#include "app/report/branches_report.hpp"

#include <drev/core/units.hpp>

#include "app/report/report_campbell.hpp"
#include "app/report/report_model.hpp"
#include "app/report/report_origin.hpp"

namespace drev::app {

namespace {

Json list_of(const Vector& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json limits_array(const NonlinearSweep& sweep, const std::vector<DrawnLimit>& limits) {
  Json sections = Json::array();
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    Json of_section = Json::array();
    for (const DrawnLimit& limit : limits)
      if (limit.section == static_cast<int>(c))
        of_section.push_back({{"name", limit.name}, {"values", list_of(limit.values)}});
    sections.push_back(std::move(of_section));
  }
  return sections;
}

}  // namespace

Json branches_report_data(const ModelRequest& model, const NonlinearSweepOptions& options,
                          const NonlinearSweep& sweep, const std::string& words,
                          const std::vector<DrawnLimit>& limits) {
  Json data = page_data("sweep", "periodic motions over speed", model, words);
  data["notes"] = branches_notes(model.system, options, sweep);
  data["shaft"] = reference_name(model.model_case.model);
  data["limits"] = limits_array(sweep, limits);
  data["result"] = branches_object(model, options, sweep);
  return data;
}

}  // namespace drev::app
