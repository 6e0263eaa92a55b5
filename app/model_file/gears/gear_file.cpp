#include "app/model_file/gears/gear_file.hpp"

#include "app/model_file/case_reader.hpp"
#include "app/model_file/field_reader.hpp"
#include "app/model_file/shared_fields.hpp"

namespace drev::app {

namespace {

/// The document's parameters with these values; what is wrong with them goes to findings.
Parameters set_parameters(const Document& document,
                          const std::vector<std::pair<std::string, std::string>>& settings,
                          std::vector<Finding>& findings) {
  Parameters parameters(document.name, document.parameters);
  for (const auto& [name, value] : settings) parameters.set(name, value);
  try {
    parameters.check();
    return parameters;
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
  return {document.name, document.parameters};
}

}  // namespace

std::vector<NamedDrawing> read_gear_drawings(
    const std::string& path, const std::vector<std::pair<std::string, std::string>>& settings) {
  const std::string text = read_text(path, nullptr);
  ReadContext context;
  std::vector<NamedDrawing> found;
  const auto take = [&](const std::string& name, const Value& table, const std::string& where) {
    NamedDrawing one;
    one.name = name;
    one.where = where;
    one.part.at = table.at;
    if (!table.is(Value::Kind::table))
      context.findings.push_back(fault_at(table.at, where, "must be a table, not " + kind_name(table)));
    else if (read_fields(
                 table, where, NodeKind::rotational, {}, [&](Fields& f) { list(f, one.drawing); }, context,
                 &one.part.fields))
      found.push_back(std::move(one));
  };
  const Value root = parse_toml(text, path);
  if (const Entry* geometry = root.find("geometry")) {
    for (const auto& [name, value] : settings)
      context.findings.push_back(
          {path, name, value, "", "is no parameter: a file with [geometry] has none, a model file may"});
    take("geometry", geometry->value, "geometry");
    for (const Entry& entry : root.entries)
      if (entry.key != "geometry")
        context.findings.push_back(fault_at(entry.at, entry.key, "is not known beside [geometry]"));
  } else {
    const Document document = read_document(text, path);
    std::vector<Finding> findings = document.findings;
    const Parameters parameters = set_parameters(document, settings, findings);
    context = context_of(document, parameters);
    context.findings = std::move(findings);
    BlockEntries entries(context);
    for (const Block& block : document.blocks) {
      if (block.elements == nullptr) continue;
      entries.for_each(block, *block.elements, [&](const Entry& element, const std::string& name) {
        if (const Entry* geometry = element.value.find("geometry"))
          take(name, geometry->value, "elements." + name + ".geometry");
      });
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
