#pragma once
/// What became of a run that was asked for as drev run is.
#include <string>
#include <vector>

namespace drev::app {

struct RunOutcome {
  std::string status;        ///< success, or what went wrong in a word; docs/results.md lists them
  std::string warning = {};  ///< why it is not success; empty if it is
  std::string text = {};     ///< the table that drev run prints
  std::string json = {};     ///< summary.json
  std::vector<std::string> notes =
      {};               ///< sentences on files that could not be written, or are of older runs
  bool written = true;  ///< all files that were asked for
  bool ok() const { return status == "success" && written; }
};

}  // namespace drev::app
