#pragma once
/// SIGINT and SIGTERM, remembered until the computation asks.
namespace drev::app {

/// From here on the first SIGINT or SIGTERM is remembered; a second one of its kind ends the process. A
/// file that outgrows its limit is a failed write, not a signal.
void watch_signals();
bool interrupted();

}  // namespace drev::app
