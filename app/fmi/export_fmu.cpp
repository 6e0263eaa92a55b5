#include "app/fmi/export_fmu.hpp"

#include <drev/app/model_file/element_table.hpp>
#include <drev/core/version.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <map>

#include "app/base/output_file.hpp"
#include "app/fmi/import/unzip.hpp"
#include "app/fmi/model_description.hpp"
#include "app/fmi/zip_file.hpp"
#include "app/model_file/writing/export.hpp"

namespace drev::app {

namespace {

namespace fs = std::filesystem;
using Contents = std::map<std::string, std::string>;  // contents by name in the archive

constexpr const char* kLibrary = "drev_fmu.so";
constexpr const char* kArchive = "fmu_library.zip";

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) throw OutputError("cannot read " + path.string());
  return text;
}

/// The deepest folder that holds all of the files.
fs::path common_folder(const std::vector<fs::path>& files) {
  fs::path common = files.front().parent_path();
  for (const fs::path& file : files)
    for (;;) {
      const auto [at, other] = std::mismatch(common.begin(), common.end(), file.begin(), file.end());
      if (at == common.end() || common == common.parent_path()) break;
      common = common.parent_path();
    }
  return common;
}

/// The model's files in their folder layout; main receives the path of the model itself.
Contents model_files(const ModelRequest& model, const FmuRequest& request, std::string& main) {
  if (!model.file) {
    main = "model/model.toml";
    return {{main, export_model(*model.entry, model.parameters, model.model_case)}};
  }
  const auto whole = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
  std::vector<fs::path> files{whole(request.model)};
  for (const std::string& file : model.model_case.files) files.push_back(whole(file));
  const fs::path common = common_folder(files);
  Contents all;
  for (const fs::path& file : files)
    all["model/" + file.lexically_relative(common).generic_string()] =
        request.text && file == files.front() ? *request.text : content_of(file);
  main = "model/" + files.front().lexically_relative(common).generic_string();
  return all;
}

/// Token that distinguishes the files of one FMU from another's: FNV-1a, twice with different starts, as a
/// GUID.
std::string token_of(const Contents& contents) {
  std::uint64_t parts[] = {0xcbf29ce484222325U, 0x84222325cbf29ce4U};
  for (std::uint64_t& hash : parts) {
    const auto add = [&](const std::string& text) {
      for (const char c : text + '\0') hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    };
    add(DREV_VERSION);
    for (const auto& [name, content] : contents) add(name), add(content);
  }
  char text[40];
  std::snprintf(text, sizeof text, "{%08x-%04x-%04x-%04x-%012llx}", static_cast<unsigned>(parts[0] >> 32),
                static_cast<unsigned>(parts[0] >> 16 & 0xffff), static_cast<unsigned>(parts[0] & 0xffff),
                static_cast<unsigned>(parts[1] >> 48),
                static_cast<unsigned long long>(parts[1] & 0xffffffffffffU));
  return text;
}

/// The name as a C identifier.
std::string identifier_of(const std::string& name) {
  std::string all = "drev_";
  for (const char c : name) all += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return all;
}

FmuInterface interface_of(const ModelRequest& model, const FmuRequest& request) {
  FmuInterface interface {
    "", request.run, "", request.torques, request.speeds, request.outputs, {}
  };
  if (!model.file) return interface;
  for (std::size_t i = 0; i < model.parameters.known().size(); ++i)
    if (model.parameters.values()[i] != model.parameters.known()[i].default_text)
      interface.parameters.emplace_back(model.parameters.known()[i].name, model.parameters.values()[i]);
  return interface;
}

/// An instance made from the resources as the FMU's library will find them.
class Extracted {
 public:
  explicit Extracted(const Contents& resources) {
    for (const auto& [name, content] : resources) {
      fs::create_directories((folder_.path / name).parent_path());
      std::ofstream(folder_.path / name, std::ios::binary) << content;
    }
    instance_ = std::make_unique<FmuInstance>(folder_.path.string());
  }

  FmuInstance& instance() const { return *instance_; }

  void check_paths() const {
    for (const std::string& file : instance_->model_case().files)
      if (!fs::path(file).lexically_normal().string().starts_with(folder_.path.string()))
        throw ModelError(
            {{file, "", "", "",
              "is named by its whole path, which an FMU cannot hold; name it relative to the model file"}});
  }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<FmuInstance> instance_;
};

void check_names(const ModelRequest& model) {
  std::vector<Finding> findings;
  for (const Parameter& parameter : model.parameters.known())
    if (model.file && parameter.name == "time")
      findings.push_back({"command line", "--fmu", "time", "",
                          "is the name of a parameter, and that of an FMU's independent variable"});
  if (!findings.empty()) throw ModelError(std::move(findings));
}

/// An FMU's library has drev's own elements alone: none of a plugin, and none that calls Python, which no file holds.
void check_elements(const ModelCase& model_case) {
  std::vector<Finding> findings;
  for (const ElementInstance& placed : model_case.model.element_instances()) {
    const auto types = element_types();
    const auto type = std::find_if(types.begin(), types.end(), [&](const ElementType& one) {
      return one.list(*placed.element, [](const ListFields&) {});
    });
    if (type == types.end() || !type->plugin.empty())
      findings.push_back(
          {model_case.model.name() + "/" + placed.name, "", "", "",
           "cannot be in an FMU: " + (type == types.end() ? "no model file can hold the element"
                                                          : "it is of the plugin " + type->plugin)});
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

}  // namespace

FmuLibrary::FmuLibrary() {
  std::error_code none;
  Dl_info self{};
  // The Python package contains them in an archive next to its extension module.
  if (::dladdr(reinterpret_cast<const void*>(&export_fmu), &self) != 0 && self.dli_fname != nullptr)
    if (const fs::path archive = fs::path(self.dli_fname).parent_path() / kArchive;
        fs::exists(archive, none)) {
      unpacked_.emplace();
      unzip(archive.string(), unpacked_->path.string());
      folder_ = unpacked_->path;
      return;
    }
  const fs::path beside = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const char* folder : {"../lib/drev", "../" DREV_FMU_FOLDER})
    if (fs::exists(beside / folder / kLibrary, none)) {
      folder_ = beside / folder;
      return;
    }
  throw OutputError(std::string(kLibrary) + " is not there: it is built with drev and installed to lib/drev");
}

void export_fmu(const ModelRequest& model, const FmuRequest& request) {
  check_names(model);
  check_elements(model.model_case);
  const FmuLibrary library;
  FmuInterface interface = interface_of(model, request);
  Contents resources = model_files(model, request, interface.model);
  resources["interface.toml"] = interface_text(interface);
  {
    const Extracted first(resources);
    first.check_paths();
    interface.tunable = first.instance().find_tunable();
  }
  resources["interface.toml"] = interface_text(interface);
  interface.token = token_of(resources);
  resources["interface.toml"] = interface_text(interface);

  const std::string identifier = identifier_of(model.model_case.model.name());
  const std::string description = model_description(Extracted(resources).instance(), request.fmi, identifier);
  create_directory(folder_of(request.file));
  ZipFile zip(request.file);
  zip.add("modelDescription.xml", description);
  for (const auto& [name, content] : resources) zip.add("resources/" + name, content);
  const std::string platform = request.fmi == 3 ? "binaries/x86_64-linux/" : "binaries/linux64/";
  std::vector<fs::path> libraries;
  for (const auto& entry : fs::directory_iterator(library.folder())) libraries.push_back(entry.path());
  std::sort(libraries.begin(), libraries.end());
  for (const fs::path& path : libraries) {
    const std::string name = path.filename().string();
    if (name.find(".so") == std::string::npos) continue;
    zip.add(platform + (name == kLibrary ? identifier + ".so" : name), content_of(path));
  }
  zip.commit();
}

}  // namespace drev::app
