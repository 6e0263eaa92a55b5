#pragma once
/// From a command line to something that can be done: the model built with its parameters, numbers checked.
/// Everything wrong with a command line is thrown as one ModelError.
#include <drev/advice/advise.hpp>
#include <drev/core/system.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/method_choice.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/command_line.hpp"
#include "app/model_file/model_file.hpp"

namespace drev::app {

/// A model with parameters, built.
struct ModelRequest {
  std::shared_ptr<const ModelEntry> entry;
  std::shared_ptr<const ModelFile> file;  ///< null for a built-in model
  Parameters parameters;
  ModelCase model_case;
  System system;
};

struct RunRequest {
  ModelRequest model;
  Method method;
  std::optional<double> accuracy;   ///< relative, of every figure; the method's step or tolerance follows
  std::string method_reason;        ///< why this one; a sentence without full stop
  bool any_method = false;          ///< none was asked for
  std::optional<double> reduce;     ///< relative error that a reduction may add; none: no reduction
  std::optional<std::string> out;   ///< directory
  std::vector<std::string> record;  ///< channels of history.csv and of the report
  double every = 0.0;               ///< s
  bool hdf5 = false;                ///< history.h5 too
  std::optional<std::string> report = {};   ///< file, .html or .pdf
  std::optional<double> report_every = {};  ///< s, asked for
  std::string words = {};                   ///< MODEL, and --run of a file
};

struct ModesRequest {
  ModelRequest model;
  ModesOptions options;
};

struct ChartRequest {
  ModelRequest model;
  std::vector<std::string> methods;
  double limit = 1.0;              ///< s of processor time, of the longest run drawn
  std::optional<std::string> out;  ///< directory
};

struct AdviseRequest {
  ModelRequest model;
  AdviseOptions options;
};

RunRequest request_run(const CommandLine& line);
ModesRequest request_modes(const CommandLine& line);
ChartRequest request_chart(const CommandLine& line);
AdviseRequest request_advise(const CommandLine& line);
ModelRequest request_model(const CommandLine& line);

/// About x, as 1, 2 or 5 times a power of ten.
double round_number(double x);

}  // namespace drev::app
