#pragma once
/// `drev run MODEL --vary ... --table`: many variants of one model in lockstep, over all processors or the ranks of
/// MPI, with one table of their figures (app/variants).
#include "app/cli/command_line.hpp"
#include "app/variants/variant_table.hpp"

namespace drev::app {

/// Whether the command line wants a table: --table, --resume or --sample, or several variants under an MPI launcher.
bool means_variants(const CommandLine& line);
/// The study that a command line asks for, wherever it is computed. Throws ModelError with everything wrong with it.
VariantStudy study_of(const CommandLine& line);
/// What of the folder keeps the study from being begun, or gone on with, is thrown as a ModelError.
void check_study_folder(const VariantStudy& study, const std::string& folder, bool resume);
/// Of a store that has all rows: writes DIR/variants.h5 and DIR/variants.json, then takes the store away. Throws
/// OutputError; the store is there then.
VariantSummary finish_table(const VariantStudy& study, VariantStore& store, const std::string& folder);
/// As run_command. Returns 0 if all variants succeeded, kInterrupted, kBadInput where those that failed have
/// parameters that cannot be, else kNotTrusted.
int run_variants(const CommandLine& line);

}  // namespace drev::app
