#include "app/report/report_page.hpp"

#include <string_view>

namespace drev::data {
extern const std::string_view report_html, report_css, dygraph_css, dygraph_js, report_js_data,
    report_js_format, report_js_train, report_js_charts, report_js_tables, report_js_modes, report_js_time,
    report_js_spectra, report_js_main;
}  // namespace drev::data

namespace drev::app {

namespace {

constexpr std::string_view kBlockBegin = "<script type=\"application/json\" class=\"run\">";
constexpr std::string_view kEnd = "</script>";

/// Replaces the marker {{name}} of the page's text.
void fill(std::string& page, const std::string& name, const std::string& text) {
  const std::string marker = "{{" + name + "}}";
  page.replace(page.find(marker), marker.size(), text);
}

}  // namespace

std::string report_page(const std::vector<std::string>& blocks) {
  std::string page(data::report_html), style, program, runs;
  for (const std::string_view part : {data::dygraph_css, data::report_css}) style += std::string(part) + "\n";
  for (const std::string_view part : {data::report_js_format, data::report_js_data, data::report_js_train,
                                      data::report_js_charts, data::report_js_tables, data::report_js_modes,
                                      data::report_js_time, data::report_js_spectra, data::report_js_main})
    program += part;
  for (const std::string& block : blocks) runs += std::string(kBlockBegin) + block + std::string(kEnd) + "\n";
  fill(page, "style", style);
  fill(page, "library", std::string(data::dygraph_js));
  fill(page, "program", program);
  fill(page, "runs", runs);
  return page;
}

std::string block_text(const Json& data) {
  const std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
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
