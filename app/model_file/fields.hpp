#pragma once
/// The keys of an element, node or run, listed once in a function list(Fields&, Params&). The same list reads
/// a table of a file into the parameters (FieldReader), writes them (FieldWriter) and names them (FieldKeys).
#include <drev/app/model_file/units.hpp>
#include <drev/core/ids.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {
class Formula;
class ModelError;
}  // namespace drev

namespace drev::app {

/// What a key holds: its name without unit, and its dimension, on a rotational node and on a translational
/// one.
struct Quantity {
  Quantity(const char* both, Dimension dimension) : Quantity(both, dimension, both, dimension) {}
  Quantity(const char* both, Dimension rotational, Dimension translational)
      : Quantity(both, rotational, both, translational) {}
  Quantity(const char* rotational, Dimension rotational_dimension, const char* translational,
           Dimension translational_dimension)
      : names{rotational, translational}, dimensions{rotational_dimension, translational_dimension} {}

  std::string name(NodeKind kind) const { return names[static_cast<int>(kind)]; }
  Dimension dimension(NodeKind kind) const { return dimensions[static_cast<int>(kind)]; }

  const char* names[2];
  Dimension dimensions[2];
};

enum class Need { optional, required };

/// One column of a table, e.g. time_s beside torque_Nm. An optional one that is missing is zero.
struct Column {
  Quantity quantity;
  std::vector<double>* values;
  Need need = Need::required;
};

/// A variable of a formula: number `number` of its variables times `factor` is what the name counts in its unit.
struct FormulaVariable {
  std::string name;
  int number = 0;
  double factor = 1.0;
};

class Fields {
 public:
  explicit Fields(NodeKind kind) : kind(kind) {}
  virtual ~Fields() = default;

  /// True where parameters are filled: then every alternative is to be listed. False where they are written:
  /// then only the one that is held.
  virtual bool reading() const = 0;
  virtual void number(const Quantity& quantity, double& value, Need need = Need::optional) = 0;
  virtual void whole(const std::string& name, int& value, Need need = Need::optional) = 0;
  virtual void flag(const std::string& name, bool& value) = 0;
  virtual void text(const std::string& name, std::string& value) = 0;
  /// A file, whose path is relative to the folder of the model file that names it. Read: as the whole path, or relative
  /// to where the program runs.
  virtual void file(const std::string& name, std::string& path, Need need = Need::optional) = 0;
  virtual void texts(const std::string& name, std::vector<std::string>& values) = 0;
  virtual void choice(const std::string& name, const std::vector<std::string>& words, int& index) = 0;
  /// An expression of these variables, needed, in `unit` or plain; variables of factor 1 stand for themselves.
  virtual void formula(const std::string& name, const std::vector<FormulaVariable>& variables,
                       const std::string& unit, std::optional<Formula>& formula) = 0;
  /// Columns of one length; true where they were given.
  virtual bool columns(const std::string& name, const std::vector<Column>& columns) = 0;
  /// A table of its own inside this one; true where it was given and its fields are right.
  virtual bool group(const std::string& name, const std::function<void(Fields&)>& list) = 0;
  /// An array of tables: resize(n) makes room for them, then list() has each by its number; true where it was given and
  /// all are right. Written are `count` of them.
  virtual bool rows(const std::string& name, std::size_t count,
                    const std::function<void(std::size_t)>& resize,
                    const std::function<void(Fields&, std::size_t)>& list) = 0;
  /// What is wrong with the table as a whole.
  virtual void fault(const std::string& sentence) = 0;
  /// A key that is given, although it has no effect beside the others: `why` says so.
  virtual void without_effect(const std::string& /*name*/, const std::string& /*why*/) {}
  /// What a computation from fields refused.
  virtual void refused(const ModelError& error) = 0;
  /// Calls make(); what it throws has been refused.
  void guarded(const std::function<void()>& make);

  const NodeKind kind;  ///< of the nodes that the fields belong to
};

using ListFields = std::function<void(Fields&)>;

/// Collects the keys with their defaults.
class FieldKeys final : public Fields {
 public:
  struct Key {
    std::string name;
    Dimension dimension = Dimension::none;
    std::string other_name = {};  ///< on a node of the other kind
    Dimension other_dimension = Dimension::none;
    Need need = Need::optional;
    double default_number = 0.0;
    std::string default_text = {};
  };
  using Fields::Fields;
  FieldKeys(NodeKind kind, const ListFields& list) : Fields(kind) { list(*this); }

  bool reading() const override { return true; }
  void number(const Quantity& quantity, double& value, Need need) override;
  void whole(const std::string& name, int& value, Need need) override;
  void flag(const std::string& name, bool& value) override;
  void text(const std::string& name, std::string& value) override;
  void file(const std::string& name, std::string& path, Need need) override;
  void texts(const std::string& name, std::vector<std::string>& values) override;
  void choice(const std::string& name, const std::vector<std::string>& words, int& index) override;
  void formula(const std::string& name, const std::vector<FormulaVariable>& variables,
               const std::string& unit, std::optional<Formula>& formula) override;
  bool columns(const std::string& name, const std::vector<Column>& columns) override;
  bool group(const std::string& name, const std::function<void(Fields&)>& list) override;
  bool rows(const std::string& name, std::size_t count, const std::function<void(std::size_t)>& resize,
            const std::function<void(Fields&, std::size_t)>& list) override;
  void fault(const std::string&) override {}
  void refused(const ModelError&) override {}

  const std::vector<Key>& keys() const { return keys_; }
  const Key* find(const std::string& name) const;
  void add(const Quantity& quantity, Need need = Need::optional, double default_number = 0.0);

 private:
  void plain(const std::string& name, Need need = Need::optional, std::string default_text = {});
  std::vector<Key> keys_;
};

}  // namespace drev::app
