// Spoils model files at random and reads them: fuzz_model_file FIRST COUNT FOLDER ...
//
// Every .toml below the folders is a seed; input k (from FIRST on) is made of one of them by one to four
// mutations that depend on k alone, so that a finding can be repeated. An input must be refused by ModelError
// whose every line names the file, a line and a column, or accepted (and then, every fourth one, written and
// read back as the same); within kSlow seconds; and memory must not grow. Anything else is printed with the
// input, and the exit code is 1.
#include <drev/app/model_file/model_file.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <sys/resource.h>
#include <vector>

#include "app/model_file/writing/export.hpp"

namespace {

constexpr double kSlow = 10.0;            // s, of one input
constexpr std::size_t kLargest = 200000;  // bytes of an input
#ifdef __SANITIZE_ADDRESS__
constexpr long kGrowth = 1L << 40;  // it keeps what was freed for a while, and tells leaks itself
#else
constexpr long kGrowth = 256 * 1024;  // kB between the first tenth of the inputs and the last
#endif

struct Seed {
  std::string path, text;
};

const std::vector<std::string>& tokens() {
  static const std::vector<std::string> all{"nan",
                                            "inf",
                                            "-inf",
                                            "1e400",
                                            "-1e400",
                                            "1e-400",
                                            "0",
                                            "-0.0",
                                            "-1",
                                            "9223372036854775807",
                                            "99999999999999999999",
                                            "1e308",
                                            "0x7f",
                                            "0b1",
                                            "true",
                                            "false",
                                            "\"\"",
                                            "''",
                                            "\"\"\"",
                                            "'''",
                                            "{}",
                                            "[]",
                                            "[[]]",
                                            "{",
                                            "}",
                                            "[",
                                            "]",
                                            "[[",
                                            "]]",
                                            "=",
                                            ".",
                                            ",",
                                            "#",
                                            "\n",
                                            "\r\n",
                                            "\t",
                                            "\"",
                                            "'",
                                            "\\",
                                            "\\u0000",
                                            "1979-05-27T07:32:00Z",
                                            "07:32:00",
                                            "\"{i}\"",
                                            "\"{i\"",
                                            "\"pi/0\"",
                                            "\"order[\"",
                                            "\"((((((((1\"",
                                            "format = 1\n",
                                            "[nodes]\n",
                                            "[elements]\n",
                                            "[[repeat]]\n",
                                            "[run]\n",
                                            "[run.x]\n",
                                            "[parameters]\n",
                                            "[tables]\n",
                                            "[lists]\n",
                                            "include = \".\"\n",
                                            "include = \"01_two_discs.toml\"\n",
                                            "count = 9999\n",
                                            "type",
                                            "node",
                                            "nodes",
                                            "hold = true",
                                            "kind = \"translational\"",
                                            "csv = \"x.csv\"",
                                            "table",
                                            "points",
                                            "_mm",
                                            "_Nm",
                                            "_rad",
                                            "\xff\xfe",
                                            "\xc3\x28",
                                            "\xef\xbb\xbf",
                                            std::string(1, '\0')};
  return all;
}

class Mutator {
 public:
  Mutator(std::uint64_t k, const std::vector<Seed>& seeds)
      : engine_(k * 0x9e3779b97f4a7c15u + 1), seeds_(seeds) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : engine_() % n; }

  std::string spoil(std::string text) {
    for (std::size_t n = 1 + below(below(3) == 0 ? 4 : 1); n > 0; --n) once(text);
    if (text.size() > kLargest) text.resize(kLargest);
    return text;
  }

 private:
  void once(std::string& text) {
    const std::size_t at = below(text.size() + 1), length = 1 + below(below(8) == 0 ? 400 : 12);
    switch (below(18)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(engine_());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size() + 1), length));
        break;
      case 3:
        text.insert(at, tokens()[below(tokens().size())]);
        break;
      case 14:
      case 15:
      case 4:
        replace_run(text, at, "0123456789.eE+-", tokens()[below(18)]);
        break;
      case 5:
        text.resize(at);
        break;
      case 6:
        move_line(text, true);
        break;
      case 7:
        move_line(text, false);
        break;
      case 8: {
        const std::string& other = seeds_[below(seeds_.size())].text;
        text.insert(at, other.substr(below(other.size() + 1), 1 + below(600)));
        break;
      }
      case 9: {
        const std::string unit[] = {"[", "{a=", "a.", "(", "-", "\"a\".", "[[", "{i"};
        const std::string& repeated = unit[below(8)];
        std::string deep;
        for (std::size_t n = below(below(6) == 0 ? 20000 : 200); n > 0; --n) deep += repeated;
        text.insert(at, deep);
        break;
      }
      case 16:
      case 17:
      case 10:
        replace_run(text, at, kWord, word(text));
        break;
      case 11:
        replace_run(text, at, kWord, tokens()[below(tokens().size())]);
        break;
      case 12:
        if (at < text.size()) text[at] ^= static_cast<char>(1 << below(7));
        break;
      default:
        text.insert(at, std::string(1 + below(3), static_cast<char>(engine_())));
        break;
    }
  }

  static constexpr const char* kWord = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

  static void replace_run(std::string& text, std::size_t at, const char* characters, const std::string& by) {
    const std::size_t begin = text.find_first_of(characters, at);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(text.find_first_not_of(characters, begin), text.size());
    text.replace(begin, end - begin, by);
  }
  std::string word(const std::string& text) {
    const std::size_t begin = text.find_first_of(kWord, below(text.size() + 1));
    if (begin == std::string::npos) return "x";
    return text.substr(begin, std::min(text.find_first_not_of(kWord, begin), text.size()) - begin);
  }
  /// Takes a line, or several, to another place; or puts a copy there.
  void move_line(std::string& text, bool copy) {
    const std::size_t begin = text.rfind('\n', below(text.size() + 1)) + 1;
    std::size_t end = begin;
    for (std::size_t n = 1 + below(6); n > 0 && end < text.size(); --n)
      end = std::min(text.find('\n', end), text.size() - 1) + 1;
    const std::string lines = text.substr(begin, end - begin);
    if (!copy) text.erase(begin, end - begin);
    text.insert(text.rfind('\n', below(text.size() + 1)) + 1, lines);
  }

  std::mt19937_64 engine_;
  const std::vector<Seed>& seeds_;
};

/// "FILE:LINE:COLUMN" with FILE in the seed's folder.
bool placed(const std::string& place) {
  const std::size_t toml = std::min(place.find(".toml:"), place.find(".csv:"));
  if (toml == std::string::npos) return false;
  const std::size_t line = place.find(':', toml) + 1, column = place.find(':', line);
  return column != std::string::npos && std::isdigit(static_cast<unsigned char>(place[line])) &&
         column + 1 < place.size() && std::isdigit(static_cast<unsigned char>(place[column + 1]));
}

/// A model case that was accepted can be written, and what is read back is written the same.
std::string write_again(const drev::app::ModelFile& file, const drev::Parameters& parameters,
                        const drev::ModelCase& model_case) {
  using namespace drev;
  std::string first;
  try {
    first = app::export_model(file.entry(), parameters, model_case);
  } catch (const ModelError&) {
    return "";  // a motion that a file gives, but an export cannot name
  }
  try {
    const app::ModelFile back(first, "again.toml", "");
    const ModelCase same = back.entry().build(Parameters(back.entry().name, {}));
    const std::string second = app::export_model(file.entry(), parameters, same);
    return first == second ? "" : "written twice, it differs:\n" + first + "\n----\n" + second;
  } catch (const ModelError& error) {
    return "written, it is refused: " + std::string(error.what()) + "\n" + first;
  }
}

/// What is wrong with how an input was taken; empty if nothing is.
std::string take(const std::string& text, const std::string& path, long& accepted) {
  using namespace drev;
  try {
    const app::ModelFile file(text, path, "");
    const Parameters parameters(file.entry().name, file.entry().parameters);
    const ModelCase model_case = file.entry().build(parameters);
    file.run_options(parameters);
    if (++accepted % 4 == 0) return write_again(file, parameters, model_case);
  } catch (const ModelError& error) {
    for (const Finding& finding : error.findings())
      if (!placed(finding.place) || finding.range.empty())
        return "a finding without place: " + finding.text();
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  }
  return "";
}

/// Thousands of segments take seconds and gigabytes, soundly.
bool large_shaft(const std::string& text) {
  for (std::size_t at = text.find("segments = "); at != std::string::npos;
       at = text.find("segments = ", at + 1)) {
    const std::size_t end = std::min(text.find_first_of("\n,}", at), text.size());
    std::size_t digits = 0;
    for (std::size_t i = at; i < end; ++i) {
      digits = std::isdigit(static_cast<unsigned char>(text[i])) ? digits + 1 : 0;
      if (digits > 3) return true;
    }
  }
  return false;
}

long resident() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "fuzz_model_file FIRST COUNT FOLDER ...\n"), 2;
  const long first = std::atol(argv[1]), count = std::atol(argv[2]);
  std::vector<Seed> seeds;
  for (int i = 3; i < argc; ++i)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (entry.path().extension() != ".toml") continue;
      std::ifstream file(entry.path(), std::ios::binary);
      seeds.push_back({entry.path().string(), {std::istreambuf_iterator<char>(file), {}}});
      // A gear pair or shaft from its drawing takes some 0.1 s to compute: tests of their own spoil those.
      const std::string& text = seeds.back().text;
      if (text.find(".geometry]") != text.npos || text.find("contour_shaft") != text.npos) seeds.pop_back();
    }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) { return a.path < b.path; });
  if (seeds.empty()) return std::fprintf(stderr, "no .toml there\n"), 2;
  long accepted = 0, faults = 0, early = 0, skipped = 0;
  double slowest = 0.0;
  for (long k = first; k < first + count; ++k) {
    Mutator mutator(static_cast<std::uint64_t>(k), seeds);
    const Seed& seed = seeds[mutator.below(seeds.size())];
    const std::string text = mutator.spoil(seed.text);
    if (large_shaft(text)) {
      ++skipped;
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    std::string wrong = take(text, seed.path, accepted);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    slowest = std::max(slowest, seconds);
    if (wrong.empty() && seconds > kSlow) wrong = "took " + std::to_string(seconds) + " s";
    if (!wrong.empty()) {
      ++faults;
      std::printf("input %ld of %s: %s\n----\n%.2000s\n----\n", k, seed.path.c_str(), wrong.c_str(),
                  text.c_str());
    }
    if (k == first + count / 10) early = resident();
  }
  const long growth = resident() - early;
  std::printf(
      "%ld inputs of %zu seeds: %ld accepted, %ld left out, %ld faults; slowest %.3f s; memory grew by %ld "
      "kB\n",
      count, seeds.size(), accepted, skipped, faults, slowest, growth);
  return faults == 0 && growth < kGrowth ? 0 : 1;
}
