#include "app/commands.hpp"

#include "app/exit_codes.hpp"
#include "app/help_texts.hpp"

namespace drev::app {

const std::vector<CommandEntry>& commands() {
  using enum OptionEntry::Values;
  static const OptionEntry run{"--run", "NAME", "Run of a model file that is meant; default: its [run]"};
  static const std::vector<CommandEntry> table{
      {.name = "run",
       .summary = "Simulates a model in time and prints what it found",
       .options = {{"--method", "METHOD", "Time integration; default: what suits the model; see below"},
                   {"--step", "SECONDS", "Time step; default: the model's"},
                   {"--tolerance", "T",
                    "Relative: of exact, default 1e-10; of any other method, whose steps it controls"},
                   {"--accuracy", "A",
                    "Finds the figures to the relative error A and states the error of each"},
                   {"--out", "DIR", "Creates DIR with history.csv, summary.json and report.html"},
                   {"--report", "FILE",
                    "Writes the report, a page for any browser, to FILE.html, or printed to FILE.pdf"},
                   {"--record", "CHANNEL,...",
                    "Columns of history.csv, curves of the report; default: the model's", commas},
                   {"--every", "SECONDS",
                    "Interval of history.csv and report; default: about duration / 1000, report: / 1e5"},
                   {"--format", "FORMAT,...", "Of the history: csv (always written), hdf5 (history.h5 too)",
                    commas},
                   run},
       .footer = std::string(kMethodsHelp) + "\n" + kRunExamples + "\n" + kExitCodesHelp,
       .execute = run_command},
      {.name = "modes",
       .summary = "Natural frequencies of a model",
       .options = {{"--count", "N", "Elastic modes; default: 10, or all if fewer"},
                   {"--contact", "STATE", "Contacts: closed (default) or open"},
                   run},
       .footer = kModesExamples,
       .execute = modes_command},
      {.name = "list",
       .summary = "The models; or one model's settings and channels",
       .options = {run},
       .footer = kListExamples,
       .execute = list_command},
      {.name = "chart",
       .summary = "Error of the methods against run time and work, on one model",
       .options = {{"--methods", "METHOD ...", "Methods drawn; default: all that fit the model", words},
                   {"--limit", "SECONDS", "Processor time of the longest run drawn; default: 1"},
                   {"--out", "DIR",
                    "Creates DIR with chart.csv, error_over_time.svg and error_over_work.svg"},
                   run},
       .footer = std::string(kMethodsHelp) + "\n" + kChartExamples,
       .execute = chart_command},
      {.name = "advise",
       .summary = "The cheapest model that finds a figure well enough, measured against the full one",
       .options = {{"--for", "FIGURE", "'peak deflection' (default), 'peak torque', 'steady peak ...'; see below"},
                   {"--within", "PART", "What it may be off by, 2% (default) or 0.02"},
                   run},
       .footer = kAdviseExamples,
       .execute = advise_command},
      {.name = "check",
       .summary = "Reads a model file and lists everything wrong with it",
       .options = {run},
       .footer = kCheckExamples,
       .execute = check_command},
      {.name = "export",
       .summary = "Writes a model as a model file",
       .options = {{"--out", "FILE", "Writes FILE, which ends in .toml; default: to standard output"}, run},
       .footer = kExportExamples,
       .execute = export_command},
      {.name = "report",
       .summary = "The report of a run once more, or of two runs compared",
       .takes_model = false,
       .options = {{"RUN", "RUN [RUN]", "Directory of drev run --out, or its report.html", words},
                   {"--out", "FILE", "The report to write, .html or .pdf"}},
       .footer = kReportExamples,
       .execute = report_command}};
  return table;
}

}  // namespace drev::app
