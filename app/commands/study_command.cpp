#include <algorithm>
#include <mutex>
#include <numeric>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/study/study_runs.hpp"

namespace drev::app {

namespace {

constexpr const char* kPictures = "pictures";
constexpr double kLeastWork = 0.5;  // s, of any group

/// One group by its name.
struct StudyEntry {
  const char* name;
  StudyGroup (*compute)();
  double work = 0.0;  ///< s of processor time, about
};

/// In the order of the report.
const std::vector<StudyEntry>& studies() {
  static const std::vector<StudyEntry> all{{"data", study_data},
                                           {"benchmark", study_benchmark},
                                           {"frequencies", study_frequencies},
                                           {"held_frequencies", study_held_frequencies},
                                           {"held", study_held, 17.0},
                                           {"run_up", study_run_up, 27.0},
                                           {"firing_order", study_firing_order, 12.0},
                                           {"gear_drive", study_gear_drive, 45.0}};
  return all;
}

/// The groups asked for, in the order of the report.
std::vector<StudyEntry> chosen(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::vector<std::string> names;
  for (const StudyEntry& entry : studies()) names.push_back(entry.name);
  const std::vector<std::string> only = line.list("--only").value_or(names);
  for (const std::string& name : only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      findings.push_back({kCommandLine, "--only", name, "",
                          "is no study; they are " + join(names) + did_you_mean(name, names)});
  if (!findings.empty()) throw ModelError(findings);
  std::vector<StudyEntry> entries;
  for (const StudyEntry& entry : studies())
    if (std::find(only.begin(), only.end(), entry.name) != only.end()) entries.push_back(entry);
  return entries;
}

}  // namespace

int study_command(const CommandLine& line) {
  const std::vector<StudyEntry> entries = chosen(line);
  const auto out = line.option("--out");
  if (out) create_directory(*out);
  watch_signals();
  // Side by side, the longest first: what one leaves of the processors at its end, another takes.
  std::vector<std::size_t> by_work(entries.size());
  std::iota(by_work.begin(), by_work.end(), std::size_t{0});
  std::stable_sort(by_work.begin(), by_work.end(),
                   [&](std::size_t a, std::size_t b) { return entries[a].work > entries[b].work; });
  double work = 0.0, done = 0.0;
  for (const StudyEntry& entry : entries) work += entry.work + kLeastWork;
  Progress progress;
  std::mutex mutex;
  std::vector<StudyGroup> groups(entries.size());
  try {
    for_all(entries.size(), [&](std::size_t i) {
      const StudyEntry& entry = entries[by_work[i]];
      groups[by_work[i]] = entry.compute();
      const std::lock_guard lock(mutex);
      progress.update((done += entry.work + kLeastWork) / work);
    });
  } catch (const SolverError&) {
    if (interrupted()) {
      std::fprintf(stderr, "drev: interrupted; nothing is written, for the study needs all of its runs\n");
      return kInterrupted;
    }
    throw;
  }
  if (out) {
    for (const StudyGroup& group : groups) {
      if (!group.pictures.empty()) create_directory(*out + "/" + kPictures);
      for (const StudyPicture& picture : group.pictures)
        write_file(*out + "/" + kPictures, "study_" + picture.name, "svg", picture.svg);
    }
    write_file(*out, "study", "md", study_as_markdown(groups, kPictures));
  }
  print(study_as_text(groups));
  return kSuccess;
}

}  // namespace drev::app
