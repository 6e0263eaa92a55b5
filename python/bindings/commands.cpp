#include "app/commands/commands.hpp"

#include <drev/app/model_file/element_table.hpp>
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/version.hpp>
#include <drev/models/model_case.hpp>

#include <dlfcn.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/cli/print.hpp"
#include "app/commands/element_list.hpp"
#include "app/commands/variants.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

const char* word_of(app::OptionEntry::Values values) {
  using enum app::OptionEntry::Values;
  switch (values) {
    case one:
      return "one";
    case commas:
    case words:
    case again:
      return "several";
    case none:
      return "flag";
  }
  return "";
}

/// The table of commands, for keyword parameters and docstrings.
nb::list command_table() {
  nb::list table;
  for (const app::CommandEntry& entry : app::commands()) {
    nb::list options;
    for (const app::OptionEntry& option : entry.options) {
      nb::list choices;
      for (const std::string& choice : option.choices) choices.append(choice);
      options.append(
          nb::make_tuple(option.name, option.type, option.meaning, word_of(option.values), choices));
    }
    table.append(nb::make_tuple(entry.name, entry.summary, options));
  }
  return table;
}

/// The output of the command, with --json or without, and its exit code.
nb::tuple execute(const Request& request, bool json) {
  app::CommandLine line = request.line();
  line.json = json;
  std::string text;
  int code = 0;
  Watch watch(request);
  try {
    const nb::gil_scoped_release unlocked;
    app::PrintedText printed;
    code = line.command->execute(line);
    text = printed.text();
  } catch (const app::Interruption&) {  // as watch says
  }
  watch.raise_if_stopped();
  return nb::make_tuple(code, text);
}

/// Loads plugins. Python loads extension modules with hidden symbols, which a plugin must see.
void load_plugins(const std::vector<std::string>& files) {
  Dl_info self{};
  if (::dladdr(reinterpret_cast<const void*>(&word_of), &self) != 0)
    ::dlopen(self.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL);
  app::load_plugins(files);
}

}  // namespace

void bind_commands(nb::module_& module) {
  module.attr("__version__") = DREV_VERSION;
  nb::class_<Stop>(module, "Stop").def(nb::init<>()).def("set", &Stop::set).def("is_set", &Stop::is_set);
  nb::class_<Request>(module, "Request")
      .def(
          "__init__",
          [](Request* self, std::string command, std::string model, std::optional<std::string> text,
             std::vector<std::pair<std::string, std::string>> parameters,
             std::map<std::string, std::vector<std::string>> options, nb::object told,
             std::shared_ptr<Stop> stop) {
            new (self) Request{std::move(command), std::move(model), std::move(text), std::move(parameters),
                               std::move(options), std::move(told),  std::move(stop)};
          },
          nb::arg("command"), nb::arg("model"), nb::arg("text").none(), nb::arg("parameters"),
          nb::arg("options"), nb::arg("told").none(), nb::arg("stop").none());
  module.def("execute", &execute, nb::arg("request"), nb::arg("json"));
  module.def("command_table", &command_table);
  module.def("elements_as_json", &app::elements_as_json);
  module.def("load_plugins", &load_plugins, nb::arg("files"));
  module.def("read_variants", [](const std::vector<std::string>& words) {
    std::vector<Finding> findings;
    std::vector<std::vector<std::pair<std::string, std::string>>> all;
    for (const app::Variant& variant : app::read_variants(words, findings)) all.push_back(variant.parameters);
    if (!findings.empty()) throw ModelError(std::move(findings));
    return all;
  });
  // What is wrong with the runs of all variants; the word of each of them is in --vary.
  module.def("check_variants", [](const Request& request) {
    app::CommandLine line = request.line();
    std::vector<Finding> findings;
    const std::vector<app::Variant> variants =
        app::read_variants(line.list("--vary").value_or(std::vector<std::string>{}), findings);
    if (!findings.empty()) throw ModelError(std::move(findings));
    line.options.erase("--vary");
    line.keeps_history = true;       // --record needs no file
    line.options["--table"] = {""};  // no method by trial, which each run does by itself
    app::request_variant(line, {variants.size(), [&](std::uint64_t i) { return variants[i].parameters; }});
  });
  module.def("built_in_models", [] {
    nb::list all;
    for (const ModelEntry& entry : ready_made_models()) all.append(nb::make_tuple(entry.name, entry.summary));
    return all;
  });
}

}  // namespace drev::python
