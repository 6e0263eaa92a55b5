#pragma once
/// ClosedFlank: a gear mesh whose teeth stay on one flank, both ways.
///
///   y = y_closed(x - offset, x', phase)      offset: +-half of the gap left out [m]
///
/// y_closed: the mesh without backlash. The same force as the mesh with its gap for as long as that flank
/// carries and no damper is limited.
#include <drev/core/element.hpp>
#include <drev/elements/gear_mesh.hpp>

#include <memory>
#include <vector>

namespace drev {

class ClosedFlank final : public Element, public ScalarForce, public AngleScaledForce {
 public:
  ClosedFlank(std::shared_ptr<const GearMesh> closed, double offset)
      : closed_(std::move(closed)),
        offset_(offset),
        pieces_(closed_->pieces().begin(), closed_->pieces().end()) {
    for (LawPiece& p : pieces_) {
      p.y_0 -= p.k * offset_, p.elastic_0 -= p.elastic_k * offset_;
      for (LawBound& b : p.bounds) b.a -= b.b_x * offset_;
    }
    for (const double kink : closed_->kinks()) kinks_.push_back(kink + offset_);
  }

  std::string_view type() const override { return "closed flank"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override { closed_->check(check); }
  void describe(int nodes, Terms& terms) const override {
    closed_->describe(nodes, terms);
    terms.scalars.back().force = this;
  }

  ScalarResponse evaluate(const ScalarInput& in) const override {
    ScalarInput moved = in;
    moved.x -= offset_;
    return closed_->evaluate(moved);
  }
  double closed_stiffness() const override { return closed_->closed_stiffness(); }
  double closed_damping() const override { return closed_->closed_damping(); }
  std::span<const double> kinks() const override { return kinks_; }
  bool varies() const override { return closed_->varies(); }
  Offset offset(double nominal_angle) const override { return closed_->offset(nominal_angle); }
  std::span<const LawPiece> pieces() const override { return pieces_; }
  double pieces_scale(double angle) const override { return closed_->pieces_scale(angle); }
  ScaleStretch scale_stretch(double angle, double direction) const override {
    return closed_->scale_stretch(angle, direction);
  }
  std::optional<double> next_knot(double angle, double direction) const override {
    return closed_->next_knot(angle, direction);
  }

 private:
  std::shared_ptr<const GearMesh> closed_;
  double offset_;
  std::vector<LawPiece> pieces_;  // one; more where the stiffness follows the load
  std::vector<double> kinks_;
};

}  // namespace drev
