#pragma once
/// Many variants of one topology: parameter studies.
///
/// Variants differ in any parameter (speeds, backlash, stiffness, damping, firing order, tables), not in
/// their unknowns, elements and connections. Constant steps of the generalized-alpha family are made by
/// kLanes variants in lockstep, one in each lane of the processor's vectors, block by block over threads;
/// anything else by one variant at a time, over threads. Results are those of single runs to rounding (of peaks in
/// steps: ManyOptions::channels), and do not depend on which variants share a block or on the number of threads.
///
/// A step that a variant cannot make with the others (Newton needs its line search, or the step must be
/// halved) it makes by itself, as a single run would.
#include <drev/core/state.hpp>
#include <drev/solvers/run/contact_record.hpp>
#include <drev/solvers/run/peak.hpp>
#include <drev/solvers/run/run_summary.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace drev {

struct ExactOptions;
struct TransientOptions;

/// Builds variant i. Called from several threads at once, when the variant's turn comes; the System is freed
/// after its run. What variants share (tables) is best built before and copied: PeriodicTable's copies share
/// their points.
using VariantBuilder = std::function<System(std::size_t i)>;

struct ManyOptions {
  /// Whose peaks are wanted: inside steps as at their ends by exact propagation; of methods that step the largest values at
  /// ends of steps, which a single run with Peaks(channels, false) has to rounding.
  std::vector<std::string> channels = {};
  int threads = 0;       ///< 0: one for each of the machine's processors
  bool lockstep = true;  ///< false: one by one in any case
  /// An exception of one variant (it cannot be built, its options do not fit) ends the whole run with it.
  /// Else it is kept as the variant's error.
  bool stop_at_error = false;
};

struct VariantResult {
  /// Text of the exception that the variant threw; if set, the other fields are unset.
  std::string error;
  RunSummary summary;
  State state;                          ///< at the end
  std::vector<Peak> peaks;              ///< of ManyOptions::channels
  std::vector<ContactRecord> contacts;  ///< of every law with a gap
  bool in_lockstep = false;
  long steps_alone = 0;  ///< steps of a lockstep run that it made by itself
  bool ok() const { return error.empty() && summary.ok(); }
};

struct ManyResult {
  std::vector<VariantResult> variants;
  std::string why_not_lockstep;  ///< empty: in lockstep
  bool interrupted = false;      ///< by the caller; variants not finished say so in their summaries
};

/// Runs variants 0 to count - 1 from their initial conditions. options.progress is called from one thread at
/// a time with the part of all that is done, 0..1. Throws ModelError if a variant's
/// topology is not that of variant 0, naming it and what differs.
ManyResult simulate_many(std::size_t count, const VariantBuilder& build, const TransientOptions& options,
                         const ManyOptions& many = {});

/// The same by exact propagation: one by one over threads, since each variant has steps of its own.
/// options.on_change is called from several threads.
ManyResult propagate_many(std::size_t count, const VariantBuilder& build, const ExactOptions& options,
                          const ManyOptions& many = {});

}  // namespace drev
