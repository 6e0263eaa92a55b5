#pragma once
/// Whether a run may be made in fewer coordinates: choose_reduction() before it, and then a trial.
///
/// Trial: the reduced system is run with TruncationError, which gives the error of every channel. Where
/// contacts change, that error is multiplied by what a small difference grows to in the reduced motion
/// (error_growth.hpp). Where the error is above what is allowed, more modes are tried once: as many as the
/// spectrum asks for an error smaller by what it was out, and by a half. Then the reduction is given up.
#include <drev/solvers/method_choice.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct TrialOptions {
  double within = 0.01;               ///< relative to each channel's peak, one of kReductionErrors
  std::vector<std::string> channels;  ///< at least one
  double duration = 0.0;              ///< s
  Method method;                      ///< of the reduced run; with any_method choose_method()'s of it
  bool any_method = false;
  std::function<bool(double)> progress = {};
};

struct ReductionTrial {
  std::optional<Reduction> reduction = {};  ///< only where the error is within
  Method method = {};                       ///< to run it with
  std::optional<double> error = {};  ///< estimated, relative, the largest of the channels'; none: no trial
  std::string channel = {};          ///< whose it is
  std::string reason = {};           ///< one sentence without full stop
};

/// Throws ModelError for bad options and unknown channels.
ReductionTrial try_reduction(const System& system, const TrialOptions& options);

}  // namespace drev
