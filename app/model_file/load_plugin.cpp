#include <drev/app/model_file/model_file.hpp>
#include <drev/app/model_file/plugin.hpp>

#include <dlfcn.h>
#include <exception>
#include <filesystem>

namespace drev::app {

namespace {

std::vector<std::string>& loaded() {
  static std::vector<std::string> files;
  return files;
}

template <class Function>
Function* symbol(void* library, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(library, name));
}

/// What is wrong with it as a library or as a plugin of this drev; empty: nothing, and it is registered.
/// Throws what registering throws.
std::string load(const std::string& file) {
  const std::filesystem::path path(file);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "is no file";
  // With a '/', so that it is this file and none of a library folder.
  void* library = ::dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    return std::string("cannot be loaded as a plugin of ") + DREV_PLUGIN_STAMP + ": " + ::dlerror();
  const auto stamp = symbol<decltype(drev_plugin_stamp)>(library, "drev_plugin_stamp");
  const auto add = symbol<decltype(drev_plugin_register)>(library, "drev_plugin_register");
  if (stamp == nullptr || add == nullptr) return "is no plugin of drev: it lacks DREV_PLUGIN()";
  const std::string built_for = stamp();
  if (built_for != DREV_PLUGIN_STAMP)
    return "was built for " + built_for + "; this is " + DREV_PLUGIN_STAMP + ": build it again";
  register_from(file, add);
  return {};
}

}  // namespace

void load_plugins(const std::vector<std::string>& files) {
  std::vector<Finding> findings;
  const auto refuse = [&](const std::string& file, const std::string& why) {
    findings.push_back({"command line", "--plugin", file, "", why});
  };
  for (const std::string& file : files) try {
      const std::string why = load(file);
      if (why.empty())
        loaded().push_back(file);
      else
        refuse(file, why);
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings()) refuse(file, "cannot be registered: " + finding.text());
    } catch (const std::exception& error) {
      refuse(file, std::string("cannot be registered: ") + error.what());
    }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

const std::vector<std::string>& loaded_plugins() { return loaded(); }

}  // namespace drev::app
