// The command drev. See drev --help.
#include <drev/app/model_file/model_file.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/completion.hpp"
#include "app/fmi/import/fmu.hpp"

namespace drev::app {

namespace {

void complain(const ModelError& error) {
  const std::size_t count = error.findings().size();
  if (count == 1) {
    std::fprintf(stderr, "drev: %s\n", error.findings().front().text().c_str());
    return;
  }
  std::fprintf(stderr, "drev: %zu faults:\n", count);
  for (const Finding& finding : error.findings()) std::fprintf(stderr, "  %s\n", finding.text().c_str());
}

/// The words of the command line; `drev report --class MODEL ... --out FILE` as `drev class MODEL ... --report FILE`.
std::vector<std::string> command_words(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  const auto flag = std::find(words.begin(), words.end(), "--class");
  if (argc < 2 || words[1] != "report" || flag == words.end()) return words;
  words.erase(flag);
  words[1] = "class";
  constexpr std::string_view kOut = "--out";
  for (std::string& word : words)
    if (word == kOut || word.starts_with(std::string(kOut) + "=")) word.replace(0, kOut.size(), "--report");
  return words;
}

int guarded_main(int argc, char** argv) {
  try {
    end_on_signals();
    std::signal(SIGXFSZ, SIG_IGN);  // what a limit refuses is an error of writing, which names its file
    register_fmu();
    if (argc > 1 && std::string_view(argv[1]) == "__complete") {
      std::string text;
      for (const std::string& offered : completions({argv + 2, argv + argc})) text += offered + "\n";
      print(text);
      return kSuccess;
    }
    std::vector<std::string> words = command_words(argc, argv);
    std::vector<char*> texts;
    for (std::string& word : words) texts.push_back(word.data());
    const ParsedCommandLine parsed =
        parse_command_line(static_cast<int>(texts.size()), texts.data(), commands());
    if (!parsed.command) return parsed.exit_code;
    const CommandLine& line = *parsed.command;
    set_quiet(line.quiet);
    load_plugins(line.list("--plugin").value_or(std::vector<std::string>{}));
    return line.command->execute(line);
  } catch (const ModelError& error) {
    complain(error);
    return kBadInput;
  } catch (const Interruption&) {
    std::fprintf(stderr, "drev: interrupted; nothing is written\n");
    return kInterrupted;
  } catch (const OutputError& error) {
    std::fprintf(stderr, "drev: %s\n", error.what());
    return kNotWritten;
  } catch (const SolverError& error) {
    std::fprintf(stderr, "drev: the computation failed: %s\n", error.what());
    return kNotTrusted;
  } catch (const std::bad_alloc&) {
    std::fprintf(
        stderr,
        "drev: there is not enough memory: take a model with fewer nodes or segments, record fewer channels "
        "(--record), or fewer rows (--every)\n");
    return kNotTrusted;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "drev: failed: %s\n", error.what());
    return kNotTrusted;
  }
}

}  // namespace
}  // namespace drev::app

int main(int argc, char** argv) { return drev::app::guarded_main(argc, argv); }
