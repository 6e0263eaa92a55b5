#pragma once
/// Models of other programs as model files: lumped trains that nothing acts on yet.
#include <string>
#include <vector>

namespace drev::app {

/// A model file, line by line, and what could not be taken over, a sentence each.
class ImportedModel {
 public:
  explicit ImportedModel(std::string name) : name_(std::move(name)) {}
  void add_node(const std::string& name);
  bool has_node(const std::string& name) const;
  /// body: "type = \"inertia\", node = ...", without braces.
  void add_element(const std::string& name, const std::string& body);
  /// body of [class.sections] for the element.
  void add_section(const std::string& element, const std::string& body);
  void not_taken(const std::string& sentence) { not_taken_.push_back(sentence); }

  const std::vector<std::string>& left_out() const { return not_taken_; }
  int node_count() const { return static_cast<int>(nodes_.size()); }
  /// The file; source: what it was read from.
  std::string toml(const std::string& source) const;

 private:
  std::string name_;
  std::vector<std::string> nodes_, element_names_, elements_, sections_, not_taken_;
};

/// openTorsion's JSON ("TORS": structure and components; opentorsion/parser.py, commit 5980fde). The elements of a
/// component follow each other; a connected component begins where the element that it is connected to ends. Disk:
/// inertia, damping to ground. ShaftDiscrete: stiffness, damping. ShaftContinuous: lengths in mm, shear modulus 80 GPa,
/// density 8000 kg/m3 unless given. GearElement: ideal gear from its parent, external, ratio of teeth or diameters.
/// Throws ModelError with everything that is wrong; `file` is its name in messages.
ImportedModel import_opentorsion(const std::string& text, const std::string& file);

/// A mass-elastic table: a row a mass, from one end to the other. Columns, each with a unit as in model files: node
/// (name), inertia, stiffness and damping (of the shaft to the next row), ratio (instead of stiffness: speed of the next
/// row over that of this one, ideal gear), ground_damping, diameter, bore (of that shaft). Lines that begin with # are
/// comments. Throws ModelError with everything that is wrong.
ImportedModel import_mass_elastic(const std::string& text, const std::string& file);

}  // namespace drev::app
