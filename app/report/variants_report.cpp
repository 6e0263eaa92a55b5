#include "app/report/variants_report.hpp"

#include "app/report/report_origin.hpp"

namespace drev::app {

Json variants_report_data(const ModelRequest& model, const Json& summary, Json points,
                          const std::string& words) {
  Json data = page_data("variants", "figures of many variants", model, words);
  data["points"] = std::move(points);
  data["result"] = summary;
  return data;
}

}  // namespace drev::app
