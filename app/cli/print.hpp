#pragma once
/// What a command prints.
#include <string>

namespace drev::app {

/// Writes to stdout, unless set_quiet(true) came first (--quiet); throws OutputError if that fails (a full
/// disk behind a redirection).
void print(const std::string& text);
void set_quiet(bool value);

/// While it lives, what this thread prints goes to a text in place of stdout, quiet or not.
class PrintedText {
 public:
  PrintedText();
  ~PrintedText();
  PrintedText(const PrintedText&) = delete;
  PrintedText& operator=(const PrintedText&) = delete;
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::string* before_;
};

}  // namespace drev::app
