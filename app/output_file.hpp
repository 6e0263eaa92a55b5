#pragma once
/// A file that is never half written under its own name: DIR/NAME.partial.EXT becomes DIR/NAME.EXT when it
/// is complete. Every write is checked.
#include <stdexcept>
#include <string>

namespace drev::app {

/// An output that could not be written; what() names the file and the system's reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Creates the directory, with those above it. Throws OutputError.
void create_directory(const std::string& directory);

class OutputFile {
 public:
  /// Opens DIR/NAME.partial.EXT, empty. Throws OutputError, also when another process is writing it.
  OutputFile(const std::string& directory, const std::string& name, const std::string& extension);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Keeps the text and writes it when enough has come together. Throws OutputError.
  void write(const std::string& text);
  /// Throws OutputError.
  void flush();
  /// Flushes and gives the file its own name. Throws OutputError.
  void commit();

  const std::string& path() const { return path_; }
  const std::string& partial_path() const { return partial_; }

 private:
  [[noreturn]] void fail(const std::string& path, int error) const;

  std::string path_, partial_, buffer_;
  int descriptor_ = -1;
};

}  // namespace drev::app
