#pragma once
/// Files that are never half written under their own name: DIR/NAME.partial.EXT becomes DIR/NAME.EXT when it
/// is complete. Every write is checked, and a file has one writer. What stands at DIR/NAME.partial.EXT is written
/// only if it is a regular file: links are not followed.
#include <stdexcept>
#include <string>
#include <sys/types.h>

namespace drev::app {

/// An output that could not be written; what() names the file and the system's reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Opens a regular file to write it, one process at a time; -1 where there is none and `flags` do not create it.
/// access: O_WRONLY or O_RDWR. What stands there may be someone else's doing: a link is not followed, a pipe or device
/// not written. Throws OutputError.
int open_to_write(const std::string& path, int flags, int access);
/// Puts the names of a directory's files on the disk.
void sync_directory(const std::string& directory);

/// Creates the directory, with those above it. Throws OutputError.
void create_directory(const std::string& directory);
/// The directory of a file; "." where its path names none.
std::string folder_of(const std::string& path);
/// DIR/NAME.partial.EXT of DIR/NAME.EXT.
std::string partial_path(const std::string& path);
/// A file as a whole: DIR/NAME.EXT. Throws OutputError.
void write_file(const std::string& directory, const std::string& name, const std::string& extension,
                const std::string& text);

/// A file that grows.
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
  std::string path_, partial_, buffer_;
  int descriptor_ = -1;
  off_t written_ = 0;
};

/// A small file that is replaced as a whole: once written, DIR/NAME.partial.EXT always holds the latest text
/// in full, also when the process is killed or the disk is full.
class ReplacedFile {
 public:
  /// Throws OutputError when another process is writing it. A leftover stays until the first text.
  ReplacedFile(const std::string& directory, const std::string& name, const std::string& extension);
  ~ReplacedFile();
  ReplacedFile(const ReplacedFile&) = delete;
  ReplacedFile& operator=(const ReplacedFile&) = delete;

  /// Throws OutputError; the text before then stays.
  void replace(const std::string& text);
  /// Gives the file its own name. Throws OutputError.
  void commit();

  const std::string& partial_path() const { return partial_; }

 private:
  std::string path_, partial_, next_;
  int descriptor_ = -1;  ///< of partial_, locked; -1: there is none
};

}  // namespace drev::app
