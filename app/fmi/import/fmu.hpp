#pragma once
/// An FMU of another tool (FMI 2.0 or 3.0, co-simulation) as a load or controller: it reads signals of the
/// train and applies torques to nodes.
///
///   tau_j = factor_j y_j            on the RIGHT side, held between communication points (sampled_controller.hpp)
///
/// At its communication points, every `step` from the start of the run, the FMU computes the past step with
/// its inputs at the end of that step (interpolate_inputs: with a straight line between both ends), and its
/// outputs then act until the next point. Between the points the train is propagated by the method of the
/// run, exactly or in steps. Holding the torques is the only error of the coupling: first order in `step`, or
/// second order with both hold = "first_order" and interpolate_inputs. The first outputs are those after
/// initialization with the inputs at the start. The library runs inside drev's process: it must be trusted
/// like any program.
/// Source: Functional Mock-up Interface 2.0.4 and 3.0, fmi-standard.org.
#include <drev/app/model_file/fields.hpp>
#include <drev/core/control/sampled_controller.hpp>

#include "app/fmi/import/unpacked_fmu.hpp"

namespace drev::app {

class Fmu final : public SampledController {
 public:
  struct Input {
    std::string variable;  ///< of the FMU: a real input
    std::string
        channel;  ///< what it is given: a channel, NODE.actual_speed_rad_per_s, time_s (signal.hpp), in SI
  };
  struct Output {
    std::string variable;  ///< of the FMU: a real output [N m or N]
    double factor = 1.0;   ///< of the torque on the node [-]
  };
  struct Parameter {
    std::string variable;  ///< of the FMU: a real, integer or boolean parameter, or one of text
    double value = kNotSet;
    std::string text = {};
    static const double kNotSet;
  };
  struct Params {
    std::string file = {};                   ///< .fmu, relative to the model file
    double step = 0.0;                       ///< h, between communication points [s], > 0
    Hold hold = Hold::zero_order;            ///< of the torques between them: zero_order or first_order
    bool interpolate_inputs = false;         ///< FMI 2.0 FMUs that can
    std::vector<Input> inputs = {};          ///< rows of variable and channel
    std::vector<Output> outputs = {};        ///< rows of variable and factor, one a node
    std::vector<Parameter> parameters = {};  ///< rows of variable and value (or text)
  };
  explicit Fmu(Params params);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "FMU"; }
  int min_nodes() const override { return params_.outputs.empty() ? 1 : SampledController::min_nodes(); }
  int max_nodes() const override { return params_.outputs.empty() ? kAnyNumber : min_nodes(); }
  void check(ParameterCheck& check) const override;
  std::vector<std::string> inputs() const override;
  std::unique_ptr<ControlSession> open(double t_start, double t_end) const override;

 private:
  static constexpr int kAnyNumber = 1000000;

  Params params_;
  std::shared_ptr<const UnpackedFmu> fmu_;  ///< none: what is wrong with the file
  std::string fault_;
};

/// The keys of `type = "fmu"`.
void list(Fields& f, Fmu::Params& p);
/// Makes the type known to model files (element_table.hpp); once, further calls do nothing.
void register_fmu();

}  // namespace drev::app
