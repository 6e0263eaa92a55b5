#pragma once
/// Texts and numbers as cells of a CSV file.
#include <string>

namespace drev::app {

/// In quotes where it holds commas, quotes or line ends (RFC 4180). A text that a spreadsheet would take for a
/// formula, as it begins with = + - @ and is no number, has a ' before it, as has one that begins so behind such
/// marks: to read it back, take one ' away.
std::string csv_cell(const std::string& text);
/// Appends 17 significant digits, with which every double reads back as it was.
void append_digits(std::string& line, double value);

}  // namespace drev::app
