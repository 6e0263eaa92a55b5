#pragma once
/// report.html: one self-contained page, without network, made of the data blocks of one run or of two, of one
/// sweep or of one study of variants, the page's text, style and program (app/report/page/) and the chart library (dygraphs).
#include <string>
#include <vector>

#include "app/base/json_values.hpp"

namespace drev::app {

enum class ReportPage { run, sweep, branches, judged, shaft, variants };

/// blocks: the text of one or two data blocks of runs (report_data.hpp), or of one sweep (sweep_report.hpp).
std::string report_page(const std::vector<std::string>& blocks, ReportPage kind = ReportPage::run);

/// A data block as text that may stand in a page.
std::string block_text(const Json& data);

/// The data of a block's text; null if it is damaged: no JSON, or without the members of a block.
Json read_block(const std::string& text);

/// The blocks of a page that report_page() made; empty if it is no such page.
std::vector<std::string> blocks_of(const std::string& page);

}  // namespace drev::app
