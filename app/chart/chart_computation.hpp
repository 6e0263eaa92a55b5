#pragma once
/// `drev chart`: error against run time and work of the methods on one model.
///
/// The runs last the model's duration, less of it where the method that is chosen for it would take more than half of the
/// limit, and not past the time at which a small difference of the state has grown by a factor of 1000: beyond, every
/// error is mostly growth, and the methods cannot be told apart. The advice is for what was measured.
#include <optional>
#include <string>
#include <vector>

#include "app/run/model_request.hpp"
#include "solvers/accuracy/work_precision.hpp"

namespace drev::app {

struct ChartRequest {
  ModelRequest model;
  std::vector<std::string> methods;
  double limit = 1.0;              ///< s of processor time, of the longest run drawn
  std::optional<std::string> out;  ///< directory
};

struct ChartResult {
  std::string quantity;        ///< what the error is of
  std::string horizon_reason;  ///< why they end before the model's duration; else empty
  WorkPrecision data;
};

/// A step that the source used for everything [s].
inline constexpr double kSourceStep = 1e-3;

ChartResult compute_chart(const ChartRequest& request);

/// Short table and conclusion.
std::string chart_as_text(const ChartRequest& request, const ChartResult& result);
std::string chart_as_json(const ChartRequest& request, const ChartResult& result);
std::string chart_as_csv(const ChartResult& result);
/// Error over processor time, or over work.
enum class ChartAxis { time, work };
/// A point whose error is below the agreement of reference and check stands on the line of the agreement.
std::string chart_as_svg(const ChartRequest& request, const ChartResult& result, ChartAxis axis);

}  // namespace drev::app
