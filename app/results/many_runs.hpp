#pragma once
/// The outcome of several runs, and its output as JSON and CSV.
#include <string>
#include <utility>
#include <vector>

#include "app/base/json_values.hpp"

namespace drev::app {

struct NamedModel {
  std::string name;   ///< name of its results: that of the built-in model, or of the file without .toml
  std::string model;  ///< the model as given to drev run
};

/// A file of a directory that is not a model.
struct SkippedFile {
  std::string file, reason;
};

struct OneOfMany {
  NamedModel model;
  std::vector<std::pair<std::string, std::string>> varied;  ///< parameters of --vary
  std::string folder;
  /// Status of its summary, or not_started, running, bad_input, killed.
  std::string status = "not_started";
  std::string reason = {};
  int code = 0;            ///< exit code of its process, -1: ended by a signal
  double wall_time = 0.0;  ///< wall time of the run [s]
  Json summary = {};       ///< its summary.json; null: there is none

  bool ended() const { return status != "not_started" && status != "running"; }
  bool ok() const { return status == "success"; }
};

struct ManyRuns {
  std::vector<OneOfMany> runs;
  std::vector<SkippedFile> skipped;
  std::string folder;
  std::string status = "running";  ///< success: all runs succeeded; failed: at least one failed; interrupted

  /// Number of the finished runs that succeeded (ok), or that did not.
  std::size_t count(bool ok) const;
};

/// runs.json, as docs/results.schema.json describes it.
std::string many_as_json(const ManyRuns& many);
/// runs.csv: one row for each run, with its parameters of --vary and its figures.
std::string many_as_csv(const ManyRuns& many);
std::string many_as_text(const ManyRuns& many);

}  // namespace drev::app
