#include "app/report/variants_report.hpp"

namespace drev::app {

Json variants_report_data(const ModelRequest& model, const VariedTexts& varied, const Json& summary,
                          Json points, const std::string& words) {
  Json data = page_data("variants", "figures of many variants", model, words, varied);
  data["points"] = std::move(points);
  data["result"] = summary;
  return data;
}

}  // namespace drev::app
