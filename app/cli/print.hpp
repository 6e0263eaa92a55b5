#pragma once
/// What a command prints.
#include <string>

namespace drev::app {

/// Writes to stdout, unless set_quiet(true) came first (--quiet); throws OutputError if that fails (a full
/// disk behind a redirection).
void print(const std::string& text);
void set_quiet(bool value);

}  // namespace drev::app
