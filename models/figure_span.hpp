#pragma once
/// Which part of a run its figures are of.
#include <drev/core/system.hpp>
#include <drev/models/model_case.hpp>

#include <optional>
#include <string>

namespace drev {

struct FigureSpan {
  double from = 0.0;     ///< s
  bool settled = false;  ///< what the start excited has died away there, or was not excited
  std::string start;     ///< what the run starts from; a phrase: "from rest"
  std::string reason;  ///< why from there; a sentence without full stop, empty: the whole run, as by default
};

/// system: that is run, from its start. periodic: it starts in the periodic steady state. duration: of the run [s].
/// turn: of the reference shaft, in which loads repeat [rad]; 0: what acts tells. The settled part must hold one cycle.
FigureSpan figure_span(const std::optional<Settle>& asked, const System& system, bool periodic,
                       double duration, double turn);

/// angle / |nominal speed| of the reference shaft, where that is the same at the start and at the end of a run of
/// this duration [s]; 0: it is not, or nothing turns.
double time_of_turn(const System& system, double angle, double duration);

}  // namespace drev
