#pragma once
/// Texts as cells of a CSV file.
#include <string>

namespace drev::app {

/// In quotes where it holds commas, quotes or line ends (RFC 4180). A text that a spreadsheet would take for a
/// formula, as it begins with = + - @ and is no number, has a ' before it, as has one that begins so behind such
/// marks: to read it back, take one ' away.
std::string csv_cell(const std::string& text);

}  // namespace drev::app
