#include "app/cli/print.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/base/output_file.hpp"

namespace drev::app {

namespace {
bool quiet = false;
thread_local std::string* printed = nullptr;
}  // namespace

PrintedText::PrintedText() : before_(printed) { printed = &text_; }
PrintedText::~PrintedText() { printed = before_; }

void set_quiet(bool value) { quiet = value; }

void print(const std::string& text) {
  if (printed != nullptr) {
    *printed += text;
    return;
  }
  if (quiet) return;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError(std::string("cannot write to standard output: ") + std::strerror(errno));
}

}  // namespace drev::app
