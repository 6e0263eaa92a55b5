#pragma once
/// Whether a modal reduction pays, and with how many modes.
///
/// Error, from the loads' spectrum beforehand: a mode j that is left out has its static part in the static
/// shapes, and lacks
///
///   |c_j| (sum_h |f_jh|/omega_j^2 |1/(1 - r^2 + 2 i zeta r) - 1| + |f_j(0)|/omega_j^2),   r = w_h/omega_j
///
/// in a channel: f_jh harmonics of the loads on the mode, zeta 0.01, and what rings when loads set in at the
/// start. Contacts ask for modes up to within^(-1/4) times the frequency of their closed stiffness on the
/// masses next to it, as no spectrum knows impacts beforehand. It is an estimate; TruncationError gives a
/// better one with the run.
///
/// Gain: exact propagation's steps go with the fastest mode, and a product costs 25 + n of the full system's
/// n unknowns, 25 + r (r + loaded nodes)/4 of the reduced system's r.
#include <drev/core/range.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/reduction/reduction.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct ReductionChoice {
  std::optional<Reduction> reduction = {};  ///< only where the gain is above 1.5
  double gain = 0.0;                        ///< predicted; 0 where nothing could be predicted
  double error = 0.0;                       ///< estimated, relative, the largest of the channels'
  std::string reason = {};                  ///< one sentence without full stop
};

/// Errors that a reduction may be allowed to add, relative.
inline constexpr Range kReductionErrors{1e-6, 0.5};

/// within: relative, of the channels' peaks, one of kReductionErrors. channels: as TruncationError takes
/// them, at least one. duration: of the run [s]. Throws ModelError for bad input.
ReductionChoice choose_reduction(const System& system, double within,
                                 const std::vector<std::string>& channels, double duration);

/// A trial of the choice: the reduced system is run with TruncationError, which gives the error of every channel.
/// Where contacts change, that error is multiplied by what a small difference grows to in the reduced motion
/// (error_growth.hpp). Where the error is above what is allowed, more modes are tried once: as many as the
/// spectrum asks for an error smaller by what it was out, and by a half. Then the reduction is given up.
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
