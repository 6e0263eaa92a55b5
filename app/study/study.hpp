#pragma once
/// `drev study`: the source's studies repeated on the reconstructed camshaft. Each group of them is computed
/// by one function, apart from writing, and gives tables with the published value, drev's at the source's
/// step of 1 ms, and the converged one with its error.
#include <drev/solvers/run/estimate.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev::app {

/// "1.2769", with at most six digits, as many as the error leaves.
std::string estimate_text(const Estimate& known);

struct StudyRow {
  std::string source;  ///< "Table 5.5"
  std::string name, unit;
  std::string published = {};       ///< as printed
  std::string at_source_step = {};  ///< drev's, average acceleration at 1 ms
  std::optional<Estimate> converged = {};
  std::string note = {};
};

struct StudyTable {
  std::string title;
  std::vector<StudyRow> rows = {};
};

struct StudyPicture {
  std::string name;  ///< of the file, without study_ and .svg
  std::string caption, svg;
};

struct StudyGroup {
  std::string title;
  std::string how = {};  ///< what was computed and how
  std::vector<StudyTable> tables = {};
  std::vector<StudyPicture> pictures = {};
  std::vector<std::string> verdicts = {};  ///< paragraphs: does the source's conclusion stand?
};

StudyGroup study_data();
StudyGroup study_frequencies();
StudyGroup study_held_frequencies();
StudyGroup study_held();
StudyGroup study_run_up();
StudyGroup study_firing_order();
StudyGroup study_gear_drive();
StudyGroup study_benchmark();

/// The report: Markdown whose pictures are at picture_folder/study_NAME.svg.
std::string study_as_markdown(const std::vector<StudyGroup>& groups, const std::string& picture_folder);
/// In brief: the verdicts.
std::string study_as_text(const std::vector<StudyGroup>& groups);

}  // namespace drev::app
