#pragma once
#include <drev/core/element.hpp>

#include <limits>
#include <memory>

namespace drev::app {

/// Stands for an element that has been refused, at its nodes: what they may lack because of it is then no fault of
/// theirs. Of the element itself, what was read of it is still checked.
class RefusedElement final : public Element {
 public:
  static constexpr const char* kRefused = "refused";  ///< its own finding, which has been said already
  /// What was read, null: nothing; whether its parameters, and its number of nodes, are those of the file.
  RefusedElement(std::shared_ptr<const Element> read, bool parameters_read, bool nodes_read)
      : read_(std::move(read)),
        parameters_read_(read_ && parameters_read),
        nodes_read_(read_ && nodes_read) {}

  std::string_view type() const override { return read_ ? read_->type() : "element"; }
  int min_nodes() const override { return nodes_read_ ? read_->min_nodes() : 0; }
  int max_nodes() const override {
    return nodes_read_ ? read_->max_nodes() : std::numeric_limits<int>::max();
  }
  void check(ParameterCheck& check) const override {
    if (parameters_read_) read_->check(check);
    check.fail(kRefused, "", "", "");
  }
  void describe(int /*nodes*/, Terms& /*terms*/) const override {}

 private:
  std::shared_ptr<const Element> read_;
  bool parameters_read_, nodes_read_;
};

}  // namespace drev::app
