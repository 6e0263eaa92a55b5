#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/chart/chart_computation.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/commands/commands.hpp"

namespace drev::app {

int chart_command(const CommandLine& line) {
  const ChartRequest request = request_chart(line);
  if (request.out) create_directory(*request.out);
  watch_signals();
  const ChartResult result = compute_chart(request);
  if (result.data.interrupted) return kInterrupted;
  if (request.out) {
    write_file(*request.out, "chart", "csv", chart_as_csv(result));
    write_file(*request.out, "error_over_time", "svg", chart_as_svg(request, result, ChartAxis::time));
    write_file(*request.out, "error_over_work", "svg", chart_as_svg(request, result, ChartAxis::work));
  }
  print(line.json ? chart_as_json(request, result) : chart_as_text(request, result));
  return kSuccess;
}

}  // namespace drev::app
