// The report of `drev study`.
#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/study/study.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kWidth = 110;

std::string error_text(const StudyRow& row) {
  if (!row.converged) return "-";
  if (!std::isfinite(row.converged->error)) return "unknown";
  return short_digits(row.converged->error, 2) +
         (row.converged->kind == Estimate::Kind::interval ? " (95 %)" : "");
}

std::string cell_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text.empty() ? " " : text;
}

std::string table_text(const StudyTable& table) {
  std::string text = "### " + table.title +
                     "\n\n"
                     "| source | quantity | unit | published | drev at 1 ms | converged | error | note |\n"
                     "|---|---|---|---|---|---|---|---|\n";
  for (const StudyRow& row : table.rows) {
    const std::string converged = row.converged ? estimate_text(*row.converged) : "-";
    text += "|";
    for (const std::string& item : {row.source, row.name, row.unit, row.published, row.at_source_step,
                                    converged, error_text(row), row.note})
      text += " " + cell_text(item) + " |";
    text += "\n";
  }
  return text + "\n";
}

std::string paragraph(const std::string& text) {
  std::string lines, line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!line.empty() && line.size() + 1 + word.size() > kWidth) lines += line + "\n", line.clear();
    if (!word.empty()) line += (line.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return lines + line + "\n\n";
}

}  // namespace

std::string estimate_text(const Estimate& known) {
  const double size = std::abs(known.value);
  int places = 6;
  if (known.error > 0.0 && size > 0.0 && std::isfinite(known.error))
    places = std::clamp(static_cast<int>(std::ceil(std::log10(size / known.error))) + 1, 2, 6);
  return size < 1e7 ? digits(known.value, places) : short_digits(known.value, places);
}

std::string study_as_markdown(const std::vector<StudyGroup>& groups, const std::string& picture_folder) {
  std::string text = "# The source's studies, repeated\n\n";
  text += paragraph(
      "Made by `drev study`; do not edit. The source (S. L. Sunde, Mechanical analysis of camshaft "
      "system on a "
      "marine engine, NTNU, 2015) beside drev on the reconstructed data. The reconstruction was "
      "fitted to the "
      "source's results, among them those at its own step (docs/validation.md): drev at 1 ms "
      "agrees with the "
      "source as well as that fit does; what is new is the column of converged values with its "
      "errors. Errors "
      "are estimates (twice the difference of two tolerances), or 95 % intervals of statistics "
      "where that is said.");
  text += "## Do the source's conclusions stand?\n\n";
  for (const StudyGroup& group : groups) {
    text += "**" + group.title + "**\n\n";
    for (const std::string& verdict : group.verdicts) text += paragraph(verdict);
  }
  for (const StudyGroup& group : groups) {
    text += "## " + group.title + "\n\n" + paragraph(group.how);
    for (const StudyTable& table : group.tables) text += table_text(table);
    for (const StudyPicture& picture : group.pictures)
      text += "![" + picture.caption + "](" + picture_folder + "/study_" + picture.name + ".svg)\n";
    text += group.pictures.empty() ? "" : "\n";
  }
  text.pop_back();  // one line end is enough
  return text;
}

std::string study_as_text(const std::vector<StudyGroup>& groups) {
  std::string text;
  for (const StudyGroup& group : groups) {
    text += group.title + "\n";
    for (const std::string& verdict : group.verdicts) text += "  " + wrap(verdict, 2);
    text += "\n";
  }
  return text;
}

}  // namespace drev::app
