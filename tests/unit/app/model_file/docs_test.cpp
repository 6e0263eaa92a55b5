// docs/model_file.md and docs/train_elements.md: every example is a sound file, or part of one; every element, key and unit is there.
#include <drev/app/model_file/element_table.hpp>
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/system.hpp>

#include "app/model_file/node_fields.hpp"
#include "app/model_file/writing/export.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;

namespace {

const std::string& page() {
  static const std::string text = test::read_file(DREV_SOURCE_DIR "/docs/model_file.md") +
                                  test::read_file(DREV_SOURCE_DIR "/docs/train_elements.md");
  return text;
}

std::vector<std::string> examples() {
  std::vector<std::string> all;
  const std::string begin = "```toml\n", end = "\n```";
  for (std::size_t at = page().find(begin); at != std::string::npos; at = page().find(begin, at)) {
    at += begin.size();
    all.push_back(page().substr(at, page().find(end, at) - at + 1));
  }
  return all;
}

/// The nodes that the examples of elements are about; those with nodes of their own have all they need.
std::string whole(const std::string& example) {
  if (example.starts_with("format")) return example;
  if (example.starts_with("[nodes]")) return "format = 1\n" + example;
  std::string text = "format = 1\n";
  for (const char* node : {"motor", "load", "pinion", "wheel"})
    text += "[nodes." + std::string(node) + "]\n[elements.J_of_" + node + "]\ntype = \"inertia\"\nnode = \"" +
            node + "\"\ninertia_kg_m2 = 1\n";
  return text +
         "[nodes.car]\nkind = \"translational\"\n[elements.m_of_car]\ntype = \"inertia\"\nnode = "
         "\"car\"\nmass_kg = 1\n" +
         example;
}

}  // namespace

TEST_CASE("Every example of the page on model files is sound") {
  CHECK(examples().size() >= 20);
  for (const std::string& example : examples()) {
    INFO(example);
    const std::string path = DREV_SOURCE_DIR "/docs/example.toml";
    std::vector<std::string> runs = app::ModelFile(whole(example), path, "").run_names();
    runs.push_back("");
    for (const std::string& run : runs) {
      const app::ModelFile file(whole(example), path, run);
      const ModelCase model_case = file.entry().build(Parameters(file.entry().name, file.entry().parameters));
      CHECK(model_case.model.build().size() > 0);
    }
  }
}

TEST_CASE("Every example of the page on elements of trains, exported and read back, is the same model") {
  const std::string path = DREV_SOURCE_DIR "/docs/example.toml";
  const std::size_t first = page().find("# Elements of real trains in model files");
  int exported = 0;
  for (const std::string& example : examples()) {
    if (page().find(example) < first) continue;
    INFO(example);
    const app::ModelFile file(whole(example), path, "");
    const Parameters parameters(file.entry().name, file.entry().parameters);
    const ModelCase model_case = file.entry().build(parameters);
    const std::string text = app::export_model(file.entry(), parameters, model_case);
    INFO(text);
    const app::ModelFile again(text, path, "");
    const ModelCase back = again.entry().build(Parameters(again.entry().name, again.entry().parameters));
    CHECK(app::export_model(file.entry(), parameters, back) == text);
    const System a = model_case.model.build(), b = back.model.build();
    REQUIRE(a.mass_values().size() == b.mass_values().size());
    CHECK(a.mass_values() == b.mass_values());
    CHECK(a.damping_values() == b.damping_values());
    CHECK(a.stiffness_values() == b.stiffness_values());
    ++exported;
  }
  CHECK(exported >= 20);
}

TEST_CASE("Every element has an example and every key is on the page") {
  for (const app::ElementType& type : app::element_types()) {
    const std::string heading = std::string("\n### ") + type.name + "\n";
    const std::size_t begin = page().find(heading);
    INFO(type.name);
    REQUIRE(begin != std::string::npos);
    const std::size_t end = page().find("\n#", begin + heading.size());
    const std::string section = page().substr(begin, end - begin);
    CHECK(contains(section, std::string("type = \"") + type.name + "\""));
    for (const NodeKind kind : {NodeKind::rotational, NodeKind::translational}) {
      app::FieldKeys keys(kind);
      type.make([&](const app::ListFields& list) { list(keys); });
      for (const auto& key : keys.keys()) {
        INFO(key.name);
        CHECK(contains(section, key.name));
        // Its example has it with a unit.
        if (kind == NodeKind::rotational) {
          bool used = key.dimension == app::Dimension::none && contains(section, key.name + " = ");
          for (const app::Unit& unit : app::units_of(key.dimension))
            used |= contains(section, key.name + "_" + unit.suffix + " = ");
          CHECK(used);
        }
      }
    }
  }
  app::NodeParams node;
  const app::FieldKeys keys(NodeKind::rotational, [&](app::Fields& f) { app::list_fields(f, node); });
  for (const auto& key : keys.keys()) CHECK(contains(page(), "`" + key.name));
}

TEST_CASE("The table of units is the one that is read") {
  for (const app::NamedDimension& d : app::dimensions()) {
    std::string row = std::string("| ") + d.name + " | ";
    for (const app::Unit& unit : app::units_of(d.dimension))
      row += (row.ends_with("| ") ? "" : ", ") + std::string(unit.suffix);
    INFO(row);
    CHECK(contains(page(), row + " |\n"));
    CHECK(app::units_of(d.dimension).front().factor == 1.0);
  }
}
