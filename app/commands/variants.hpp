#pragma once
/// The combinations of --vary as runs of their own, each with a folder (app/variants/varied.hpp has the values' form).
#include <drev/core/error.hpp>

#include <string>
#include <utility>
#include <vector>

namespace drev::app {

struct Variant {
  std::vector<std::pair<std::string, std::string>> parameters;
  /// "backlash_mm=0.1,engine_rpm=750"; empty without parameters.
  std::string name() const;
};

/// Every combination, the last parameter varying fastest; one Variant without parameters where there are no
/// words.
std::vector<Variant> read_variants(const std::vector<std::string>& words, std::vector<Finding>& findings);

}  // namespace drev::app
