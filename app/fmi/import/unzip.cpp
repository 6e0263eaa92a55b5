#include "app/fmi/import/unzip.hpp"

#include <filesystem>
#include <fstream>
#include <memory>
#include <minizip/unzip.h>
#include <stdexcept>
#include <vector>

namespace drev::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 4096;
constexpr unsigned kEncrypted = 1;                        // bit in the flags of an entry
constexpr unsigned kFileKind = 0170000, kLink = 0120000;  // bits of a Unix file mode
constexpr std::size_t kRead = std::size_t{1} << 18;       // bytes read at once

/// Whether the name, with '/' between folders, stays in the folder that it is unpacked to.
bool stays_inside(const std::string& name) {
  if (name.empty() || name.front() == '/' || name.find('\\') != std::string::npos ||
      name.find(':') != std::string::npos || name.find('\0') != std::string::npos)
    return false;
  for (const fs::path& part : fs::path(name))
    if (part == "..") return false;
  return true;
}

class Archive {
 public:
  explicit Archive(const std::string& path) : zip_(unzOpen64(path.c_str()), unzClose) {
    if (!zip_) throw std::runtime_error("is no ZIP archive");
  }

  void unpack(const fs::path& folder, const UnzipLimits& limits) {
    unz_global_info64 all{};
    if (unzGetGlobalInfo64(zip_.get(), &all) != UNZ_OK) throw std::runtime_error("is damaged");
    if (all.number_entry > limits.files)
      throw std::runtime_error("holds " + std::to_string(all.number_entry) + " files; at most " +
                               std::to_string(limits.files) + " are unpacked");
    limit_ = left_ = limits.bytes;
    for_each(all.number_entry, [this](const std::string& /*name*/, std::uint64_t size) { take(size); });
    left_ = limits.bytes;
    for_each(all.number_entry,
             [&](const std::string& name, std::uint64_t /*size*/) { unpack_one(folder, name); });
  }

 private:
  /// Every entry with its name and the size that the archive says, once both are found harmless.
  template <class Use>
  void for_each(std::uint64_t count, const Use& use) {
    int at = unzGoToFirstFile(zip_.get());
    for (std::uint64_t i = 0; i < count; ++i) {
      unz_file_info64 info{};
      std::string name(kLongestName + 1, '\0');
      if (at != UNZ_OK || unzGetCurrentFileInfo64(zip_.get(), &info, name.data(), name.size(), nullptr, 0,
                                                  nullptr, 0) != UNZ_OK)
        throw std::runtime_error("is damaged");
      if (info.size_filename > kLongestName) throw std::runtime_error("holds a name that is too long");
      name.resize(info.size_filename);
      if (!stays_inside(name))
        throw std::runtime_error("holds the path '" + name + "', which leads out of it");
      if ((info.external_fa >> 16 & kFileKind) == kLink)
        throw std::runtime_error("holds the link '" + name + "'");
      if ((info.flag & kEncrypted) != 0) throw std::runtime_error("is encrypted");
      use(name, info.uncompressed_size);
      at = unzGoToNextFile(zip_.get());
    }
  }

  void take(std::uint64_t bytes) {
    if (bytes > left_)
      throw std::runtime_error("holds more than " + std::to_string(limit_) + " bytes unpacked");
    left_ -= bytes;
  }

  void unpack_one(const fs::path& folder, const std::string& name) {
    if (name.back() == '/') {
      fs::create_directories(folder / name);
      return;
    }
    fs::create_directories((folder / name).parent_path());
    if (unzOpenCurrentFile(zip_.get()) != UNZ_OK)
      throw std::runtime_error("holds '" + name + "' in a way of packing that is not known");
    std::ofstream file(folder / name, std::ios::binary);
    std::vector<char> part(kRead);
    for (;;) {
      const int got = unzReadCurrentFile(zip_.get(), part.data(), static_cast<unsigned>(part.size()));
      if (got < 0) throw std::runtime_error("is damaged at '" + name + "'");
      if (got == 0) break;
      take(static_cast<std::uint64_t>(got));  // the sizes stated in the archive are not trusted
      file.write(part.data(), got);
    }
    if (unzCloseCurrentFile(zip_.get()) != UNZ_OK) throw std::runtime_error("is damaged at '" + name + "'");
    file.close();
    if (!file) throw std::runtime_error("cannot be unpacked to " + (folder / name).string());
  }

  std::unique_ptr<void, int (*)(void*)> zip_;
  std::uint64_t limit_ = 0, left_ = 0;
};

}  // namespace

void unzip(const std::string& archive, const std::string& folder, const UnzipLimits& limits) {
  Archive(archive).unpack(folder, limits);
}

}  // namespace drev::app
