#pragma once
/// Everything that `drev run` reports, as data. What has no meaning for a model, or could not be found, is
/// absent, with the reason.
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/element_totals.hpp>
#include <drev/solvers/run/peak.hpp>
#include <drev/solvers/run/run_summary.hpp>
#include <drev/solvers/strength/rainflow.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "app/run/run_request.hpp"
#include "app/run/run_up.hpp"
#include "models/figure_span.hpp"
#include "solvers/run/mean_speed.hpp"

namespace drev::app {

/// Largest |value| of a channel (or of several: of which).
struct Largest {
  double value = 0.0;  ///< unit below
  std::string channel, unit;
  double at = 0.0;                   ///< s; angle of the reference shaft [rad] of a static value
  std::optional<double> error = {};  ///< of the value; none: unchecked
  /// The part of the channel's name before its quantity: element, node or NODE-NODE.
  std::string place() const { return channel.substr(0, channel.rfind('.')); }
};

struct Contacts {
  ContactRecord record;
  std::string force_unit;  ///< N or N m
  /// With their errors, of which some may be infinite: unknown; none: unchecked.
  std::optional<ContactFigures> known = {};
  std::string speed_unit() const { return force_unit == "N" ? "m/s" : "rad/s"; }
};

/// What a section carried.
struct SectionPeaks {
  std::string channel, unit;
  Peak whole;    ///< of the whole run
  Peak settled;  ///< of the span that figures are of
  /// Permissible half range in continuous running, the lower one at the nominal speeds of the span's maximum and minimum, where
  /// the model says so; not a number: none.
  double permissible = SectionStrength::kNone;
  double half_range() const { return 0.5 * (settled.max - settled.min); }
};

/// Of a run in fewer coordinates, or why it is not.
struct ReductionNote {
  bool used = false;
  int coordinates = 0, of = 0;  ///< of the run; unknowns of the model
  int modes = 0, static_shapes = 0;
  std::optional<double> error = {};  ///< estimated, relative to the peak of `channel`, the largest of all
  std::string channel = {};
  std::string reason = {};  ///< a sentence without full stop
};

inline constexpr double kSpeedOff = 1e-3;  ///< of the nominal speed: beyond it the run says so

struct RunResult {
  /// success, energy_error, unstable, no_convergence, not_finite, interrupted; failed: ended by an error;
  /// output_error: ended because an output could not be written.
  std::string status = "success";
  std::string reason;
  Method method;  ///< with the step or tolerance that an accuracy asked for led to
  std::string method_reason;
  FigureSpan span;                     ///< what the figures are of
  std::optional<SpeedsPassed> run_up;  ///< where the nominal speed changes
  std::vector<PartSpeed> speeds;       ///< over the span, of parts that nothing holds at the nominal speed
  ReductionNote reduction;
  RunSummary summary;
  std::optional<AccuracyResult> accuracy;
  std::optional<ModeSet> modes;
  std::string modes_reason;
  std::optional<Largest> deflection, force, static_force;
  std::optional<Largest> mesh_force;  ///< over meshes and whatever else has a gap [N]
  std::string static_reason;          ///< why there is no static force
  std::vector<Contacts> contacts;
  std::vector<SectionPeaks> sections;           ///< of the model's torques
  std::vector<RainflowWatch::Result> rainflow;  ///< load cycles over the span
  std::vector<ElementTotals::Row> elements;     ///< energies over the span, where they were asked for
  double modes_time = 0.0, static_time = 0.0, reduction_time = 0.0, accuracy_time = 0.0,
         run_time = 0.0;  ///< s of wall time

  bool ok() const { return status == "success"; }
  /// s, that figures are of; 0 where the run did not come so far.
  double span_length() const { return summary.t_end > span.from ? summary.t_end - span.from : 0.0; }
  /// The first part whose mean speed is off the nominal one by more than kSpeedOff; null: none.
  const PartSpeed* off_speed() const;
  /// Largest force over largest static force.
  std::optional<double> amplification() const {
    if (!force || !static_force || !(static_force->value > 0.0)) return {};
    return force->value / static_force->value;
  }
};

inline const PartSpeed* RunResult::off_speed() const {
  for (const PartSpeed& part : speeds)
    if (!(std::abs(part.actual - part.nominal) <= kSpeedOff * std::abs(part.nominal))) return &part;
  return nullptr;
}

}  // namespace drev::app
