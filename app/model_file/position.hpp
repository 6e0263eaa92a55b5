#pragma once
/// A place in a model file.
#include <memory>
#include <string>

namespace drev::app {

/// file:line:column, both counted from 1.
struct Position {
  std::shared_ptr<const std::string> file;
  int line = 1, column = 1;
  std::string text() const;
};

}  // namespace drev::app
