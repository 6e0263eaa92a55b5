#include <drev/app/run_model.hpp>

#include "app/commands/run_request.hpp"
#include "app/report/run_files.hpp"

namespace drev::app {

RunOutcome run_model(const RunOrder& order) {
  return run_and_write(
      request_run({.model = order.model, .parameters = order.parameters, .options = order.options}));
}

}  // namespace drev::app
