#pragma once
/// DIR/variants.h5: the table of a study, a row a variant, a dataset a column. First the parameters varied (numbers, or
/// texts), then `status` (an enumeration), then the figures, not a number where a variant has none; each with its unit
/// as an attribute. The file's attributes are `drev` (version), `study` (what the rows follow from, JSON) and `summary`
/// (variants.json as text). The same study gives the same bytes, on however many threads and ranks it ran.
#include <string>

#include "app/variants/variant_statistics.hpp"
#include "app/variants/variant_store.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

/// What became of a study.
struct VariantSummary {
  Json json;         ///< variants.json, as docs/variants.schema.json describes it
  std::string text;  ///< for people
  int exit_code = 0;
};
VariantSummary summary_of(const VariantStudy& study, const VariantStatistics& statistics,
                          const VariantStore& store, const std::string& folder);

std::string table_path(const std::string& folder);
/// How long the texts of a parameter's column are; 0: it holds numbers.
std::size_t text_size(const Varied& varied);
/// Of a parameter of the model.
std::string unit_of(const VariantStudy& study, const std::string& name);

/// Both passes over the store's rows.
VariantStatistics statistics_of(const VariantStudy& study, const VariantStore& store);

/// Writes folder/variants.h5. Throws OutputError; what stood there then stays.
void write_variant_table(const VariantStudy& study, const VariantStore& store, const std::string& folder,
                         const std::string& summary);
/// The attributes `study` and `summary` of the table in the folder; nullopt: there is none.
std::optional<Json> study_of_table(const std::string& folder);
std::optional<Json> summary_of_table(const std::string& folder);
/// What a process returns whose study has this summary: 0 if all variants succeeded, 2 where those that failed have
/// parameters that cannot be, else 1.
int exit_code_of(const Json& summary);

}  // namespace drev::app
