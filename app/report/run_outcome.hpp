#pragma once
/// The outcome of a run that was requested as by drev run.
#include <string>
#include <vector>

namespace drev::app {

struct RunOutcome {
  std::string status;        ///< success, or what went wrong in a word; docs/results.md lists them
  std::string warning = {};  ///< why status is not success; empty if it is
  std::string text = {};     ///< the table that drev run prints
  std::string json = {};     ///< summary.json
  std::vector<std::string> notes =
      {};               ///< sentences on files that could not be written, or are of older runs
  bool written = true;  ///< true: all requested files were written
  bool ok() const { return status == "success" && written; }
};

}  // namespace drev::app
