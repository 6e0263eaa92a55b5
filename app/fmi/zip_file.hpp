#pragma once
/// Writes a ZIP archive by minizip (zlib licence).
#include <string>
#include <string_view>

namespace drev::app {

class ZipFile {
 public:
  /// Creates DIR/NAME.partial.EXT for the path DIR/NAME.EXT. Throws OutputError, like the other functions.
  explicit ZipFile(const std::string& path);
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  /// Adds a file, compressed; names have '/' between folders.
  void add(const std::string& name, std::string_view content);
  /// Completes the archive and gives it its own name.
  void commit();

 private:
  std::string path_, partial_;
  void* zip_ = nullptr;
};

}  // namespace drev::app
