#pragma once
/// A study's blocks, shared by the threads and ranks that there are: whoever has no more gets the next ones. The
/// first rank hands them out and alone writes the store; where it runs by itself, its threads do all the work.
#include <string>

#include "app/variants/ranks.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

struct WorkOutcome {
  bool interrupted = false;
  double seconds = 0.0;        ///< of wall time
  std::uint64_t computed = 0;  ///< variants, now; those found in the store are not among them
  std::string fault;           ///< what ended another rank; empty: nothing
};

/// For the first rank: returns when all blocks are in the store and on the disk, when the user interrupts, or when
/// another rank failed. Throws OutputError where the store cannot be written; the other ranks have ended then, too.
WorkOutcome lead_work(const VariantStudy& study, const Ranks& ranks, int threads, VariantStore& store);

/// For the others: until the first rank says that it is over, or the user interrupts.
void follow_work(const VariantStudy& study, const Ranks& ranks, int threads);

/// For a rank that has no study to work on: tells the first one why (empty: it knows), or all others that there is
/// no work.
void decline_work(const Ranks& ranks, const std::string& why);

}  // namespace drev::app
