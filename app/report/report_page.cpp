#include "app/report/report_page.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <string_view>

#include "app/report/report_spectra.hpp"

namespace drev::data {
extern const std::string_view report_html, report_css, dygraph_css, dygraph_js, report_js_data,
    report_js_format, report_js_page, report_js_train, report_js_charts, report_js_save, report_js_bars,
    report_js_tables, report_js_modes, report_js_time, report_js_spectra, report_js_main, report_js_sweep,
    report_js_sweep_main, report_js_class, report_js_shaft, report_js_branches, report_js_variants;
}  // namespace drev::data

namespace drev::app {

namespace {

constexpr std::string_view kBlockBegin = "<script type=\"application/json\" class=\"run\">";
constexpr std::size_t kMostGroups = std::size_t{1} << 28;  // more groups of a history than a page can hold
constexpr std::string_view kEnd = "</script>";

/// The parts in which pages differ: their sections, and the parts of their program.
struct PageParts {
  std::vector<std::pair<const char*, const char*>> sections;  ///< id and heading
  std::vector<std::string_view> program;
};

PageParts parts_of(ReportPage kind) {
  if (kind == ReportPage::judged)
    return {{{"judgement", "Judgement"},
             {"masselastic", "Mass-elastic system"},
             {"figures", "Vibration"},
             {"speeds", "Vibration over speed"},
             {"orders", "Orders at a speed"},
             {"campbell", "Campbell diagram"},
             {"rules", "Rules, and what is not judged"},
             {"inputs", "Inputs"}},
            {data::report_js_format, data::report_js_page, data::report_js_train, data::report_js_save,
             data::report_js_charts, data::report_js_bars, data::report_js_sweep, data::report_js_class}};
  if (kind == ReportPage::shaft)
    return {{{"shafts", "Shafts"}, {"inputs", "Inputs"}},
            {data::report_js_format, data::report_js_page, data::report_js_save, data::report_js_charts,
             data::report_js_shaft}};
  if (kind == ReportPage::sweep)
    return {
        {{"figures", "Results"},
         {"model", "Model"},
         {"speeds", "Vibration over speed"},
         {"orders", "Orders at a speed"},
         {"campbell", "Campbell diagram"},
         {"inputs", "Inputs"}},
        {data::report_js_format, data::report_js_page, data::report_js_train, data::report_js_save,
         data::report_js_charts, data::report_js_bars, data::report_js_sweep, data::report_js_sweep_main}};
  if (kind == ReportPage::variants)
    return {{{"figures", "Results"},
             {"histograms", "Distributions"},
             {"sensitivity", "Sobol indices"},
             {"scatter", "Figures over parameters"},
             {"model", "Model"},
             {"inputs", "Inputs"}},
            {data::report_js_format, data::report_js_page, data::report_js_train, data::report_js_save,
             data::report_js_charts, data::report_js_variants}};
  if (kind == ReportPage::branches)
    return {{{"figures", "Results"},
             {"model", "Model"},
             {"speeds", "Vibration over speed"},
             {"inputs", "Inputs"}},
            {data::report_js_format, data::report_js_page, data::report_js_train, data::report_js_save,
             data::report_js_charts, data::report_js_branches}};
  return {{{"figures", "Results"},
           {"model", "Model"},
           {"modes", "Modes"},
           {"campbell", "Campbell diagram"},
           {"histories", "Time histories"},
           {"contacts", "Meshes and contacts"},
           {"spectra", "Spectra and orders"},
           {"energy", "Energy balance"},
           {"accuracy", "Accuracy"},
           {"method", "Method"},
           {"inputs", "Inputs"}},
          {data::report_js_format, data::report_js_data, data::report_js_page, data::report_js_train,
           data::report_js_save, data::report_js_charts, data::report_js_bars, data::report_js_tables,
           data::report_js_modes, data::report_js_time, data::report_js_spectra, data::report_js_main}};
}

/// Replaces the first marker {{name}} of the page's text.
void fill(std::string& page, const std::string& name, const std::string& text) {
  const std::string marker = "{{" + name + "}}";
  page.replace(page.find(marker), marker.size(), text);
}

/// A random word that nobody can know before the report is made.
std::string new_nonce() {
  std::random_device random;
  std::vector<std::uint32_t> words(4);
  for (std::uint32_t& word : words) word = random();
  return base64(words);
}

/// The content security policy: the browser may run the page's own two programs, which have the nonce, and
/// nothing else. Content of a text of a run is neither executed nor fetched.
std::string policy(const std::string& nonce) {
  return "default-src 'none'; script-src 'nonce-" + nonce +
         "'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";
}

constexpr const char* kChecksum = "checksum";

std::string dumped(const Json& data) { return data.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// FNV-1a, 64 bits, of the data written without their checksum, in hexadecimal digits (G. Fowler, L. C. Noll, K.-P.
/// Vo, D. Eastlake, The FNV Non-Cryptographic Hash Algorithm). It detects accidental damage; it does not
/// prove origin.
std::string checksum_of(const Json& data) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : dumped(data)) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(hash >> shift) & 15U];
  return text;
}

/// Whether the data are those that were written; data of a version without a checksum are accepted.
bool is_sound(const Json& data) {
  if (!data.contains(kChecksum)) return data.contains("format") && data.at("format") == 1;
  Json bare = data;
  bare.erase(kChecksum);
  return data.at(kChecksum) == checksum_of(bare);
}

/// Whether this is the base64 text of `bytes` bytes.
bool is_base64(const Json& text, std::size_t bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (!text.is_string()) return false;
  const std::string& letters = text.get_ref<const std::string&>();
  const std::size_t end = letters.find_first_not_of(kLetters);
  return letters.size() == (bytes + 2) / 3 * 4 &&
         letters.find_first_not_of('=', std::min(end, letters.size())) == letters.npos &&
         letters.size() - std::min(end, letters.size()) == (3 - bytes % 3) % 3;
}

/// Whether every series of a history has all its values.
bool is_history(const Json& history) {
  if (!history.is_object() || !history.contains("series") || !history.at("series").is_array()) return false;
  const Json groups = history.value("groups", Json());
  if (!groups.is_number_unsigned() || groups > kMostGroups) return false;
  const std::size_t bytes = groups.get<std::size_t>() * sizeof(float);
  for (const Json& series : history.at("series")) {
    if (!series.is_object() || !is_base64(series.value("low", Json()), bytes)) return false;
    if (series.contains("high") && !is_base64(series.at("high"), bytes)) return false;
  }
  return true;
}

}  // namespace

std::string report_page(const std::vector<std::string>& blocks, ReportPage kind) {
  std::string page(data::report_html), style, program, runs, sections;
  const PageParts parts = parts_of(kind);
  for (const std::string_view part : {data::dygraph_css, data::report_css}) style += std::string(part) + "\n";
  for (const std::string_view part : parts.program) program += part;
  for (const auto& [id, heading] : parts.sections)
    sections += std::string("  <section id=\"") + id + "\"><h2>" + heading + "</h2></section>\n";
  for (const std::string& block : blocks) runs += std::string(kBlockBegin) + block + std::string(kEnd) + "\n";
  const std::string nonce = new_nonce();
  fill(page, "policy", policy(nonce));
  for (int program_number = 0; program_number < 2; ++program_number) fill(page, "nonce", nonce);
  fill(page, "sections", sections);
  fill(page, "style", style);
  fill(page, "library", std::string(data::dygraph_js));
  fill(page, "program", program);
  fill(page, "runs", runs);
  return page;
}

Json read_block(const std::string& text) {
  const Json data = Json::parse(text, nullptr, false);
  const auto has = [&](const char* key, bool (Json::*is)() const noexcept) {
    return data.contains(key) && (data.at(key).*is)();
  };
  const bool whole = data.is_object() && has("result", &Json::is_object) && has("model", &Json::is_object) &&
                     data.contains("history") && is_history(data.at("history")) &&
                     has("inputs", &Json::is_array) && has("modes", &Json::is_array) &&
                     data.contains("campbell") && data.contains("spectra") &&
                     has("command", &Json::is_string) && has("about", &Json::is_string) &&
                     has("version", &Json::is_string) && has("made", &Json::is_string);
  return whole && is_sound(data) ? data : Json();
}

std::string block_text(const Json& data) {
  Json sealed = data;
  sealed.erase(kChecksum);
  sealed[kChecksum] = checksum_of(sealed);
  const std::string text = dumped(sealed);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) c == '<' ? out += "\\u003c" : out += c;  // "</script>" must not end the block
  return out;
}

std::vector<std::string> blocks_of(const std::string& page) {
  std::vector<std::string> blocks;
  for (std::size_t begin = page.find(kBlockBegin); begin != page.npos;) {
    begin += kBlockBegin.size();
    const std::size_t end = page.find(kEnd, begin);
    if (end == page.npos) return {};
    blocks.push_back(page.substr(begin, end - begin));
    begin = page.find(kBlockBegin, end);
  }
  return blocks;
}

}  // namespace drev::app
