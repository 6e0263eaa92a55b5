#pragma once
/// Printing of a page as PDF by the installed Chromium.
#include <string>

namespace drev::app {

inline constexpr const char* kNoBrowser =
    "needs Chromium, which is not installed here (Debian's package: chromium; Ubuntu 24.04's snap: "
    "chromium). "
    "Without it: --report FILE.html, which any browser prints well";

/// Path of chromium, chromium-browser, google-chrome; empty: none is installed.
std::string find_browser();

/// The PDF of a page of report_page(), printed in a folder of its own inside `folder`, which is removed. Throws
/// OutputError if no complete PDF results.
std::string print_as_pdf(const std::string& page, const std::string& folder);

}  // namespace drev::app
