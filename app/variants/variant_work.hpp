#pragma once
/// Distribution of a study's blocks over threads and ranks: whichever has no more gets the next ones. The
/// first rank hands them out and is the only one that writes the store; if it runs alone, its threads do all
/// the work.
#include <string>

#include "app/variants/ranks.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

struct WorkOutcome {
  bool interrupted = false;
  double seconds = 0.0;        ///< wall time [s]
  std::uint64_t computed = 0;  ///< variants computed in this run, without those found in the store
  std::string fault;           ///< why another rank ended; empty: none ended early
};

/// For the first rank: returns when all blocks are in the store and on the disk, when the user interrupts, or when
/// another rank failed. Throws OutputError if the store cannot be written; the other ranks have then ended,
/// too.
WorkOutcome lead_work(const VariantStudy& study, const Ranks& ranks, int threads, VariantStore& store);

/// For the other ranks: returns when the first rank ends the work, or the user interrupts.
void follow_work(const VariantStudy& study, const Ranks& ranks, int threads);

/// For a rank that has no study to work on: tells the first rank why (empty: it knows), or, as the first
/// rank, tells all others that there is no work.
void decline_work(const Ranks& ranks, const std::string& why);

}  // namespace drev::app
