#pragma once
/// Which part of a run its figures are of.
#include <drev/core/system.hpp>

#include <optional>
#include <string>

#include "app/run/run_request.hpp"

namespace drev::app {

struct FigureSpan {
  double from = 0.0;     ///< s
  bool settled = false;  ///< what the start excited has died away there, or was not excited
  std::string start;     ///< what the run starts from; a phrase: "from rest"
  std::string reason;  ///< why from there; a sentence without full stop, empty: the whole run, as by default
};

/// system: that is run, from its start. periodic: it starts in the periodic steady state. cycle: s, of which the
/// settled part must hold one; 0: none.
FigureSpan figure_span(const std::optional<Settle>& asked, const System& system, bool periodic,
                       double duration, double cycle);

}  // namespace drev::app
