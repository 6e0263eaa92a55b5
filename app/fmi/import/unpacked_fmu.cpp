#include "app/fmi/import/unpacked_fmu.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <fstream>
#include <map>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "app/fmi/import/unzip.hpp"

namespace drev::app {

namespace {

namespace fs = std::filesystem;

#if defined(__x86_64__)
constexpr const char* kPlatforms[] = {"linux64", "x86_64-linux"};  // of FMI 2, FMI 3
#else
constexpr const char* kPlatforms[] = {"aarch64-linux", "aarch64-linux"};
#endif

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The platforms of an FMU for a message: "; it has linux32, win64", or that it has none.
std::string platforms_in(const fs::path& binaries) {
  std::string all;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(binaries, none))
    all += (all.empty() ? "" : ", ") + entry.path().filename().string();
  return all.empty() ? "it has no library at all" : "it has those for " + all;
}

}  // namespace

static std::vector<void*>& loaded_libraries() {
  static std::vector<void*> libraries;
  return libraries;
}

/// A library that shares symbols with others (STB_GNU_UNIQUE) remains loaded after dlclose(), and is
/// finalized after its static objects. PythonFMU's finalizer would then release one of them twice; if it is
/// called earlier, it does nothing later.
static void close_last_library() {
  void* library = loaded_libraries().back();
  loaded_libraries().pop_back();
  if (void* finalizer = ::dlsym(library, "finalizePythonInterpreter"))
    reinterpret_cast<void (*)()>(finalizer)();
  ::dlclose(library);
}

UnpackedFmu::UnpackedFmu(const std::string& file) : name_(fs::path(file).filename().string()) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) throw std::runtime_error("is no file");
  unzip(file, folder_.path.string());
  const fs::path description = folder_.path / "modelDescription.xml";
  if (!fs::is_regular_file(description, none))
    throw std::runtime_error("is no FMU: it holds no modelDescription.xml");
  description_ = read_description(text_of(description));
}

void UnpackedFmu::load() const {
  const fs::path binaries = folder_.path / "binaries";
  const std::string platform = kPlatforms[description_.fmi - 2];
  const fs::path path = binaries / platform / (description_.identifier + ".so");
  std::error_code none;
  if (!fs::is_regular_file(path, none))
    throw std::runtime_error("has no library for this machine (binaries/" + platform + "/" +
                             description_.identifier + ".so); " + platforms_in(binaries));
  library_ = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) throw std::runtime_error(std::string("cannot be loaded: ") + ::dlerror());
  // Closed before the library's own static objects, which its finalizers may use (PythonFMU's do): exit
  // handlers that are registered last run first.
  loaded_libraries().push_back(library_);
  if (std::atexit(close_last_library) != 0) loaded_libraries().pop_back();
}

void* UnpackedFmu::function(const std::string& name) const {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (library_ == nullptr) load();
  void* found = ::dlsym(library_, name.c_str());
  if (found == nullptr) throw std::runtime_error("its library has no function " + name);
  return found;
}

std::shared_ptr<const UnpackedFmu> unpacked_fmu(const std::string& file) {
  struct Known {
    fs::file_time_type written;
    std::uintmax_t size;
    std::shared_ptr<const UnpackedFmu> fmu;
  };
  static std::mutex mutex;
  static std::map<fs::path, Known> all;
  std::error_code none;
  const fs::path path = fs::weakly_canonical(file, none);
  const fs::file_time_type written = fs::last_write_time(path, none);
  const std::uintmax_t size = fs::file_size(path, none);
  const std::lock_guard lock(mutex);
  const auto found = all.find(path);
  if (found != all.end() && found->second.written == written && found->second.size == size)
    return found->second.fmu;
  auto fmu = std::make_shared<const UnpackedFmu>(file);
  all.insert_or_assign(path, Known{written, size, fmu});
  return fmu;
}

}  // namespace drev::app
