#pragma once
/// Where nodes and elements stand, so that what a model says of them can be said of a line of the file.
#include <map>
#include <set>
#include <vector>

#include "app/model_file/field_reader.hpp"

namespace drev::app {

/// A node or element.
struct Part {
  Position at;
  FieldPlaces fields = {};
  NodeKind kind = NodeKind::rotational;
};

/// Elements that a system lacks because something is wrong with them, or was not read of them.
struct LeftOut {
  std::set<std::string> elements;
  /// Whether a name, or one that fits this pattern, may be of such an element: its own, or that of a part of it.
  bool may_have(const std::string& name) const;
};

/// The finding with its place in the file, which is that of the field that its parameter is of:
/// "stiffness.single" of stiffness_step, "x[2]" of points. `place` says what stands there.
Finding placed(Finding finding, const Part& part, const std::string& place);

/// The same for what Model::build() found; what is of no node or element is of the file as a whole.
std::vector<Finding> placed(const ModelError& error, const std::string& model, const Position& file,
                            const std::map<std::string, Part>& nodes,
                            const std::map<std::string, Part>& elements);

/// A fault of a table that several elements use, or of a repeat, is one fault: the name and the value may
/// differ.
void remove_repeated(std::vector<Finding>& findings);

inline constexpr std::size_t kMostFaults = 200;  ///< that are listed of one file
/// Removes repeated ones, and those beyond the limit, which it counts instead.
void limit_findings(std::vector<Finding>& findings, const Position& file);

}  // namespace drev::app
