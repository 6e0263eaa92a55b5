#pragma once
/// What the process returns; scripts may rely on it (`drev --help` says the same).
namespace drev::app {

enum ExitCode : int {
  kSuccess = 0,
  kNotTrusted = 1,  ///< the run failed numerically, or its energy balance is off
  kBadInput = 2,    ///< options, parameters, model or channels that cannot be
  kNotWritten = 3,  ///< an output could not be written
  kInterrupted = 130
};

inline constexpr const char* kExitCodesHelp =
    "Exit codes:\n"
    "  0    success\n"
    "  1    the result is not to be trusted (energy balance off), or the computation failed\n"
    "  2    bad input: option, parameter, model or channel; every fault found is listed\n"
    "  3    an output could not be written\n"
    "  130  interrupted\n";

}  // namespace drev::app
