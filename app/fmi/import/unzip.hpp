#pragma once
/// Unpacks a ZIP archive by minizip (zlib licence), without trusting its content.
#include <cstdint>
#include <string>

namespace drev::app {

/// Limits of the content of an archive.
struct UnzipLimits {
  std::uint64_t files = 10000;
  std::uint64_t bytes = std::uint64_t{1} << 30;  ///< largest unpacked size [bytes]
};

/// Unpacks every file into the folder, which must exist. Throws std::runtime_error for a file that is no
/// archive, that is damaged or encrypted or beyond the limits, and for one that names a path outside the
/// folder or contains a link.
void unzip(const std::string& archive, const std::string& folder, const UnzipLimits& limits = {});

}  // namespace drev::app
