#pragma once
/// ContourShaft: a shaft between two nodes by its contour, as segments with inertia.
///
///   k_i = G/(flexibility of segment i),  J_i its inertia;   K = k [1 -1; -1 1],  M as SegmentMass says
///
/// Segments, their flexibility with steps, fillets and cams, and their inertia are those of shaft_sections().
/// Averaged mass J/12 [5 1; 1 5] unless told otherwise. Torque is that of a positive twist, end b minus end a;
/// outputs "1".."n" count the segments from a to b. Nodes: a (left end), b, then the n - 1 internal ones from a to b.
/// Takes part in Rayleigh damping. A contour that cannot be is reported by check().
#include <drev/core/element_interface.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

#include <memory>

namespace drev {

class ContourShaft final : public Element {
 public:
  using Params = ShaftContour;
  explicit ContourShaft(Params params);

  std::string_view type() const override { return "contour shaft"; }
  int min_nodes() const override { return 2; }
  std::vector<NodeKind> internal_nodes() const override;
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;
  int part_count() const override;
  std::vector<int> part_nodes(int part) const override;
  void describe_part(int part, Terms& terms) const override;

  const Params& params() const { return params_; }
  /// Null where the contour cannot be: check() says why.
  const ShaftSections* sections() const { return sections_.get(); }

 private:
  Params params_;
  std::shared_ptr<const ShaftSections> sections_;
  std::vector<Finding> findings_;
};

}  // namespace drev
