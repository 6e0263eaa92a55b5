#include "app/model_file/gears/gear_file.hpp"

#include "app/model_file/case_reader.hpp"
#include "app/model_file/field_reader.hpp"
#include "app/model_file/shared_fields.hpp"

namespace drev::app {

std::vector<NamedDrawing> read_gear_drawings(const std::string& path) {
  const std::string text = read_text(path, nullptr);
  ReadContext context;
  std::vector<NamedDrawing> found;
  const auto take = [&](const std::string& name, const Value& table, const std::string& where) {
    NamedDrawing one{name, {}};
    if (!table.is(Value::Kind::table))
      context.findings.push_back(fault_at(table.at, where, "must be a table, not " + kind_name(table)));
    else if (read_fields(
                 table, where, NodeKind::rotational, {}, [&](Fields& f) { list(f, one.drawing); }, context))
      found.push_back(std::move(one));
  };
  const Value root = parse_toml(text, path);
  if (const Entry* geometry = root.find("geometry")) {
    take("geometry", geometry->value, "geometry");
    for (const Entry& entry : root.entries)
      if (entry.key != "geometry")
        context.findings.push_back(fault_at(entry.at, entry.key, "is not known beside [geometry]"));
  } else {
    const Document document = read_document(text, path);
    context = context_of(document, Parameters(document.name, document.parameters));
    context.findings = document.findings;
    for (const Block& block : document.blocks) {
      if (block.elements == nullptr || block.repeat != nullptr) continue;
      for (const Entry& element : block.elements->entries)
        if (const Entry* geometry = element.value.find("geometry"))
          take(element.key, geometry->value, "elements." + element.key + ".geometry");
    }
    if (found.empty() && context.findings.empty())
      context.findings.push_back(
          {path, "geometry", "", "",
           "is missing: the file needs a table [geometry], or gear meshes with one; docs/gears.md"});
  }
  if (!context.findings.empty()) throw ModelError(std::move(context.findings));
  return found;
}

}  // namespace drev::app
