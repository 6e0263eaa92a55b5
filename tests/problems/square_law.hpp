#pragma once
/// A torque that grows with the square of the speed: -factor w |w|, as a propeller or fan takes it.
#include <drev/core/element.hpp>
#include <drev/core/load.hpp>

#include <cmath>
#include <string_view>

namespace drev {

class SquareLaw final : public Element, public Load {
 public:
  struct Params {
    double factor = 0.0;  // N m s^2/rad^2
  };
  explicit SquareLaw(Params params) : params_(params) {}
  std::string_view type() const override { return "square law"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    check.positive("factor", params_.factor, "N m s^2/rad^2");
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    return {.torque = -params_.factor * in.speed * std::abs(in.speed),
            .dtorque_dspeed = -2.0 * params_.factor * std::abs(in.speed)};
  }

 private:
  Params params_;
};

}  // namespace drev
