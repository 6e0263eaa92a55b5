#pragma once
/// The report of a study of many variants: one page with the statistics of every figure and their intervals,
/// histograms, Sobol indices, and scatter plots of figures over parameters.
#include <string>

#include "app/base/json_values.hpp"
#include "app/report/report_origin.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// The page's data for report_page(..., ReportPage::variants). summary: variants.json; points: rows of the
/// table (app/variants/variant_points.hpp); words: the command that reproduces it, without the model's
/// parameters.
Json variants_report_data(const ModelRequest& model, const VariedTexts& varied, const Json& summary,
                          Json points, const std::string& words);

}  // namespace drev::app
