#pragma once
/// What became of several runs, and how it is told.
#include <string>
#include <utility>
#include <vector>

#include "app/base/json_values.hpp"

namespace drev::app {

struct NamedModel {
  std::string name;   ///< of its results: the built-in model's, or the file's without .toml
  std::string model;  ///< as drev run takes it
};

/// A file of a directory that is no model.
struct SkippedFile {
  std::string file, reason;
};

struct OneOfMany {
  NamedModel model;
  std::vector<std::pair<std::string, std::string>> varied;  ///< parameters of --vary
  std::string folder;
  /// That of its summary, or not_started, running, bad_input, killed.
  std::string status = "not_started";
  std::string reason = {};
  int code = 0;            ///< exit code of its process, -1: ended by a signal
  double wall_time = 0.0;  ///< s
  Json summary = {};       ///< null: there is none

  bool ended() const { return status != "not_started" && status != "running"; }
  bool ok() const { return status == "success"; }
};

struct ManyRuns {
  std::vector<OneOfMany> runs;
  std::vector<SkippedFile> skipped;
  std::string folder;
  std::string status = "running";  ///< success: of all; failed: at least one; interrupted

  /// Of those that have ended: that succeeded, or that did not.
  std::size_t count(bool ok) const;
};

/// runs.json, as docs/results.schema.json describes it.
std::string many_as_json(const ManyRuns& many);
/// runs.csv: a row a run, with its parameters of --vary and its figures.
std::string many_as_csv(const ManyRuns& many);
std::string many_as_text(const ManyRuns& many);

}  // namespace drev::app
