#pragma once
/// What `drev run` is asked for, checked: the run is computed from it, and its results name it.
#include <drev/solvers/method.hpp>
#include <drev/solvers/start.hpp>

#include <optional>
#include <string>
#include <vector>

#include "app/run/model_request.hpp"

namespace drev::app {

struct RunRequest {
  ModelRequest model;
  Method method;
  std::optional<double> accuracy;   ///< relative, of every figure; the method's step or tolerance follows
  std::string method_reason;        ///< why this one; a sentence without full stop
  bool any_method = false;          ///< none was asked for
  std::optional<double> reduce;     ///< relative error that a reduction may add; none: no reduction
  bool any_reduce = false;          ///< nothing was said on it, and any method is right
  std::optional<std::string> out;   ///< directory
  std::vector<std::string> record;  ///< channels of history.csv and of the report
  double every = 0.0;               ///< s
  bool hdf5 = false;                ///< history.h5 too
  std::optional<std::string> report = {};   ///< file, .html or .pdf
  std::optional<double> report_every = {};  ///< s, asked for
  std::string words = {};                   ///< MODEL, and --run of a file
  Start start = Start::rest;
  std::optional<Settle> settle = {};       ///< none: figures are of the whole run
  std::optional<double> duration = {};     ///< s, asked for in place of the model's
  std::optional<std::string> events = {};  ///< file of the contact events, .csv
  bool keeps_history = false;              ///< what runs it keeps the recorded channels, without a file
  std::vector<std::string> rainflow = {};  ///< channels counted beside the sections with an S-N line
  bool energy = false;                     ///< work, heat and stored energy of each element, too
  std::string orders_of = {};  ///< node whose turns orders are of where nothing turns nominally; empty: found
};

}  // namespace drev::app
