#pragma once
/// Numbers and paragraphs for people.
#include <string>
#include <vector>

namespace drev::app {

/// With about so many significant digits: 91.68, 43530, 1.5e-07.
std::string digits(double value, int significant);
/// With at most so many: 5, 0.001, 3.221e-05.
std::string short_digits(double value, int significant);

/// The value with the digits that its error supports, down to the error's second; three where it is not known, at
/// most twelve where it is zero.
std::string earned_digits(double value, double error);

/// Text padded with blanks to the width, on the right or on the left.
std::string pad_right(const std::string& text, std::size_t width);
std::string pad_left(const std::string& text, std::size_t width);

/// Words wrapped at 100 columns, every line but the first indented; ends with a line end.
std::string wrap(const std::string& text, std::size_t indent);

/// Columns, each as wide as its widest cell and two blanks from the next; the first on the left, the others on
/// the right; a line a row.
std::string columns_text(const std::vector<std::vector<std::string>>& rows);

/// The width of the labels that texts for people begin their lines with.
inline constexpr std::size_t kLabel = 24;
/// The label, padded to it, and the text, wrapped beside it.
std::string labelled(const std::string& label, const std::string& text);

/// "a,b,,c" as a, b, nothing, c: always one part more than there are separators.
std::vector<std::string> split(const std::string& text, char separator);

/// "a, b, c".
std::string join(const std::vector<std::string>& items, const std::string& separator = ", ");

}  // namespace drev::app
