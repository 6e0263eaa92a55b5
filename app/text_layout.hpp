#pragma once
/// Numbers and paragraphs for people.
#include <string>
#include <vector>

namespace drev::app {

/// With about so many significant digits: 91.68, 43530, 1.5e-07.
std::string digits(double value, int significant);
/// With at most so many: 5, 0.001, 3.221e-05.
std::string short_digits(double value, int significant);

/// Text padded with blanks to the width, on the right or on the left.
std::string pad_right(const std::string& text, std::size_t width);
std::string pad_left(const std::string& text, std::size_t width);

/// Words wrapped at 100 columns, every line but the first indented; ends with a line end.
std::string wrap(const std::string& text, std::size_t indent);

/// "a, b, c".
std::string join(const std::vector<std::string>& items, const std::string& separator = ", ");

}  // namespace drev::app
