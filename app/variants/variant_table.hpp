#pragma once
/// DIR/variants.h5: the table of a study, with one row for each variant and one dataset for each column. The
/// columns are the varied parameters (numbers or texts), then `status` (an enumeration), then the figures,
/// not a number where a variant has none; each with its unit as an attribute. The file's attributes are
/// `drev` (version), `study` (everything that the rows depend on, as JSON) and `summary` (variants.json as
/// text). The same study gives the same bytes for any number of threads and ranks.
#include <string>

#include "app/variants/variant_statistics.hpp"
#include "app/variants/variant_store.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

inline constexpr std::size_t kFailuresKept =
    1000;  ///< largest number of failures, and of warnings, in variants.json

/// The outcome of a study.
struct VariantSummary {
  Json json;                 ///< variants.json, as docs/variants.schema.json describes it
  std::string remarks = {};  ///< which variants failed or have a warning, as readable text
  std::string text;          ///< the summary as readable text, with the remarks
  int exit_code = 0;
};
VariantSummary summary_of(const VariantStudy& study, const VariantStatistics& statistics,
                          const VariantStore& store, const std::string& folder);

std::string table_path(const std::string& folder);
/// Length of the texts in a parameter's column [bytes]; 0: the column has numbers.
std::size_t text_size(const Varied& varied);
/// Unit of a parameter of the model.
std::string unit_of(const VariantStudy& study, const std::string& name);

/// The statistics, by both passes over the rows of the store.
VariantStatistics statistics_of(const VariantStudy& study, const VariantStore& store);

/// Writes folder/variants.h5. Throws OutputError; an older file then remains.
void write_variant_table(const VariantStudy& study, const VariantStore& store, const std::string& folder,
                         const std::string& summary);
/// The attributes `study` and `summary` of the table in the folder; nullopt: there is none.
std::optional<Json> study_of_table(const std::string& folder);
std::optional<Json> summary_of_table(const std::string& folder);
/// Exit code of a process whose study has this summary: 0 if all variants succeeded, 2 if all that failed
/// have invalid parameters, otherwise 1.
int exit_code_of(const Json& summary);

}  // namespace drev::app
