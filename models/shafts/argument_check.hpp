#pragma once
/// Checks of a function's arguments: everything that is wrong is thrown at once.
#include <drev/core/error.hpp>

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drev {

struct KeptFindings {
  std::vector<Finding> findings = {};
};

class ArgumentCheck : private KeptFindings, public ParameterCheck {
 public:
  explicit ArgumentCheck(std::string function) : ParameterCheck(std::move(function), findings) {}
  ArgumentCheck(const ArgumentCheck&) = delete;
  ArgumentCheck& operator=(const ArgumentCheck&) = delete;

  /// Lengths [m] that must be > 0.
  void lengths(std::initializer_list<std::pair<std::string_view, double>> all) {
    for (const auto& [name, value] : all) positive(name, value, "m");
  }
  bool sound() const { return findings.empty(); }
  /// Throws ModelError with what was found so far, if anything was.
  void refuse() const {
    if (!findings.empty()) throw ModelError(findings);
  }
};

}  // namespace drev
