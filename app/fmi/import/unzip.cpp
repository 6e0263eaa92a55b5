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
constexpr unsigned kEncrypted = 1;                         // of an entry's flags
constexpr unsigned kFileKind = 0170000, kLink = 0120000;   // of a mode of Unix
constexpr std::size_t kRead = std::size_t{1} << 18;        // bytes read at once

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
    left_ = limits.bytes;
    int at = unzGoToFirstFile(zip_.get());
    for (std::uint64_t i = 0; i < all.number_entry; ++i) {
      if (at != UNZ_OK) throw std::runtime_error("is damaged");
      unpack_one(folder, limits);
      at = unzGoToNextFile(zip_.get());
    }
  }

 private:
  void unpack_one(const fs::path& folder, const UnzipLimits& limits) {
    unz_file_info64 info{};
    std::string name(kLongestName + 1, '\0');
    if (unzGetCurrentFileInfo64(zip_.get(), &info, name.data(), name.size(), nullptr, 0, nullptr, 0) != UNZ_OK)
      throw std::runtime_error("is damaged");
    if (info.size_filename > kLongestName) throw std::runtime_error("holds a name that is too long");
    name.resize(info.size_filename);
    if (!stays_inside(name)) throw std::runtime_error("holds the path '" + name + "', which leads out of it");
    if ((info.external_fa >> 16 & kFileKind) == kLink) throw std::runtime_error("holds the link '" + name + "'");
    if ((info.flag & kEncrypted) != 0) throw std::runtime_error("is encrypted");
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
      // Counted as they come: what the archive says of its sizes is not believed.
      if (static_cast<std::uint64_t>(got) > left_)
        throw std::runtime_error("holds more than " + std::to_string(limits.bytes) + " bytes unpacked");
      left_ -= static_cast<std::uint64_t>(got);
      file.write(part.data(), got);
    }
    if (unzCloseCurrentFile(zip_.get()) != UNZ_OK) throw std::runtime_error("is damaged at '" + name + "'");
    file.close();
    if (!file) throw std::runtime_error("cannot be unpacked to " + (folder / name).string());
  }

  std::unique_ptr<void, int (*)(void*)> zip_;
  std::uint64_t left_ = 0;
};

}  // namespace

void unzip(const std::string& archive, const std::string& folder, const UnzipLimits& limits) {
  Archive(archive).unpack(folder, limits);
}

}  // namespace drev::app
