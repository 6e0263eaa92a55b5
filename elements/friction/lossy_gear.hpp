#pragma once
/// LossyGear: a rigid speed ratio between two shafts with efficiency by direction of power, bearing friction and
/// self-locking.
///
///   omega_2 = ratio omega_1                                          exactly
///   shaft 1 drives    P = efficiency_forward tau_1 - sign(omega_1) bearing_torque_forward
///   shaft 2 drives    tau_1 = efficiency_backward (P + sign(omega_1) bearing_torque_backward)
///
/// tau_1 is the torque that shaft 1 puts into the gear, P what comes out, referred to shaft 1 (shaft 2 gets P / ratio).
/// The loss torque tau_1 - P is the larger of the two while omega_1 > 0, the lesser while omega_1 < 0. At omega_1 = 0 it
/// is whatever keeps the gear at rest, between those two bounds: the gear is stuck, truly, until its torques leave them.
/// That, and which shaft drives, is located (solvers/exact/friction_series.hpp); nothing is regularised.
///
/// efficiency_backward <= 0 is a self-locking gear (a worm): no torque on shaft 2 turns it; to lower a load, shaft 1 must
/// drive too. Then the load's inertia referred to shaft 1, times |efficiency_backward|, must be less than that of shaft
/// 1: otherwise the gear jams, which ends the run with an error.
///
/// Efficiencies are those of the teeth; the bearing torques, referred to shaft 1, hold for a driving shaft 1 and 2.
/// Tables over |omega_1| are linear between their points, constant beyond. Each shaft needs an inertia, and none a
/// given motion. Exact propagation takes it; modes see it without loss, that is as an ideal gear.
///
/// Source: Modelica Standard Library, Rotational.Components.LossyGear (its ratio is 1/ratio; lossTable columns |w_a|,
/// eta_mf1, eta_mf2, tau_bf1, tau_bf2); C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of
/// gearboxes and of planetary gearboxes, Proc. 2nd Int. Modelica Conference, 2002.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/elements/not_given.hpp>

#include <vector>

namespace drev {

class LossyGear final : public Element, public Friction {
 public:
  struct Params {
    double ratio = kNotGiven;                ///< omega_2 / omega_1 [-], finite, not 0; external pair: < 0
    double efficiency_forward = kNotGiven;   ///< shaft 1 drives [-], > 0, <= 1
    double efficiency_backward = kNotGiven;  ///< shaft 2 drives [-], <= 1; <= 0: self-locking
    double bearing_torque_forward = 0.0;     ///< N m at shaft 1, >= 0
    double bearing_torque_backward = 0.0;    ///< N m at shaft 1, >= 0
    /// Or all four over |omega_1| [rad/s], ascending from 0.
    std::vector<double> speeds = {}, efficiencies_forward = {}, efficiencies_backward = {},
                        bearing_torques_forward = {}, bearing_torques_backward = {};
  };
  explicit LossyGear(Params params);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "lossy gear"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

  const std::vector<double>& slip_speeds() const override { return loss_.speeds; }
  const std::vector<double>& sliding_torques() const override { return loss_.bearing_forward; }
  const GearLoss* gear_loss() const override { return &loss_; }

 private:
  class Tie final : public Friction {
   public:
    const std::vector<double>& slip_speeds() const override { return zero_; }
    const std::vector<double>& sliding_torques() const override { return zero_; }
    bool rigid() const override { return true; }

   private:
    std::vector<double> zero_{0.0};
  };

  Params params_;
  GearLoss loss_;
  Tie tie_;
};

}  // namespace drev
