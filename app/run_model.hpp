#pragma once
/// A run as `drev run` does it, for a program of one's own: reads the model, runs it, writes history, summary
/// and report. Elements that the program has registered (app/model_file/element_table.hpp) stand in its
/// files.
///
///   const RunOutcome outcome = run_model({.model = "my.toml", .options = {{"--report", {"my.html"}}}});
///   std::cout << outcome.text;
#include <drev/app/report/run_outcome.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drev::app {

struct RunOrder {
  std::string model;  ///< a model file, FILE.toml, or the name of a built-in model
  std::vector<std::pair<std::string, std::string>> parameters = {};  ///< of the model, as --set gives them
  /// As on the command line of drev run, which has their ranges: {{"--out", {"DIR"}}, {"--method",
  /// {"exact"}}}.
  std::map<std::string, std::vector<std::string>> options = {};
};

/// Throws ModelError with everything that is wrong with model, parameters and options, and OutputError where
/// files cannot be opened. What fails later is in the outcome.
RunOutcome run_model(const RunOrder& order);

}  // namespace drev::app
