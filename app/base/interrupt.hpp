#pragma once
/// SIGINT and SIGTERM, remembered until the computation asks.
namespace drev::app {

/// From here on the first SIGINT or SIGTERM is remembered; a second one of its kind ends the process, and so does
/// the first where no one asks for 10 s: exit code 130, files as they are when a process is killed. A
/// file that outgrows its limit is a failed write, not a signal.
void watch_signals();
bool interrupted();

}  // namespace drev::app
