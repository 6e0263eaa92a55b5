#include "app/commands/variants.hpp"

#include "app/base/text_layout.hpp"
#include "app/variants/variant_plan.hpp"

namespace drev::app {

namespace {

constexpr double kMostVariants = 10000;  // folders

}  // namespace

std::string Variant::name() const {
  std::vector<std::string> parts;
  for (const auto& [name, value] : parameters) parts.push_back(name + "=" + value);
  return join(parts, ",");
}

std::vector<Variant> read_variants(const std::vector<std::string>& words, std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  const VariantPlan plan(read_varied(words, kMostVariants, findings), {}, {}, findings);
  if (findings.size() > before) return {Variant{}};
  std::vector<Variant> variants;
  for (std::uint64_t i = 0; i < plan.count(); ++i) variants.push_back({plan.parameters(i)});
  return variants;
}

}  // namespace drev::app
