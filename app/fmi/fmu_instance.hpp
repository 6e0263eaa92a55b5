#pragma once
/// An instance of an FMU, for both versions of FMI: the model with its inputs, its state, and its steps by
/// exact propagation. Wrong use throws FmuError, an invalid model ModelError, a failed computation
/// SolverError; the instance is then as before the call.
#include <drev/core/channel.hpp>
#include <drev/core/system.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>

#include "app/fmi/fmu_interface.hpp"
#include "app/fmi/fmu_state.hpp"

namespace drev {
struct ExactOptions;
}

namespace drev::app {

class ModelFile;

class FmuError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Requests of an importer for a step.
struct FmuStepWishes {
  bool end_at_change = false;  ///< true: the step ends where a contact changes
  /// Called at points inside the step: real() then gives the outputs there, and nothing may be set.
  std::function<void(double t)> inside = {};
};
struct FmuStepped {
  std::string warning = {};  ///< warning; empty: none
  bool at_change = false;    ///< true: the step ended at a contact change
};

class FmuInstance {
 public:
  /// resources: the folder that contains interface.toml. Builds the model with the parameters' start values.
  explicit FmuInstance(const std::string& resources);
  ~FmuInstance();
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;

  const FmuInterface& interface() const { return interface_; }
  /// The variables, indexed by value reference.
  const std::vector<FmuVariable>& variables() const { return variables_; }
  const std::vector<Parameter>& parameters() const;
  const ModelCase& model_case() const;
  /// The real parameters that may change while a simulation runs: those that leave unknowns, nominal and
  /// prescribed motions and initial conditions unchanged. They are found by trying values near the start
  /// values.
  std::vector<std::string> find_tunable() const;
  FmuMode mode() const { return state_.mode; }

  /// The value of a value reference; throws FmuError for one that does not exist or has another type.
  double real(unsigned reference);
  int integer(unsigned reference) const;
  const std::string& text(unsigned reference) const;
  /// Throws FmuError if one of them cannot be set now; then none is set.
  void set_reals(const unsigned* references, const double* values, std::size_t count);
  void set_integers(const unsigned* references, const int* values, std::size_t count);
  void set_texts(const unsigned* references, const std::vector<std::string>& values);
  /// The first time derivatives of inputs over the next step [unit of the input per s].
  void set_input_slopes(const unsigned* references, const double* values, std::size_t count);

  /// tolerance: relative tolerance [-], 0: the default. t_start, t_stop [s]; a stop time is none that steps may pass.
  void enter_initialization(double t_start, std::optional<double> t_stop, double tolerance);
  /// Returns a warning of the start state; empty: none.
  std::string exit_initialization();
  /// A step from t over h [s], or to the first contact change if that is requested.
  FmuStepped step(double t, double h, const FmuStepWishes& wishes = {});
  /// sum_j (dy_i/du_j) seed_j of outputs y by inputs u in the current state, with the inputs as set: the
  /// direct feedthrough (accelerations, reactions, forces of dampers at a prescribed speed). By central
  /// differences, which are exact within rounding where the law is linear.
  std::vector<double> directional_derivative(const std::vector<unsigned>& unknowns,
                                             const std::vector<unsigned>& knowns,
                                             const std::vector<double>& seed);
  void terminate();
  void reset();

  const FmuState& state() const { return state_; }
  /// Throws FmuError for a state of another model.
  void set_state(const FmuState& state);

 private:
  struct Built;
  class Inside;

  const FmuVariable& variable(unsigned reference, FmuVariable::Type type) const;
  const FmuVariable& settable(unsigned reference, FmuVariable::Type type) const;
  void require(bool right, const char* call, const char* when) const;
  void set_parameters(const std::vector<std::pair<std::size_t, std::string>>& values);
  std::unique_ptr<Built> build(const std::vector<std::string>& parameters) const;
  /// Finds the start state of the model with the current inputs.
  void start();
  void hand_inputs_on();
  double reached(const SpeedInput& input, std::size_t i, double t) const;
  std::optional<double> first_change(const ExactOptions& options);
  double output(std::size_t place);

  std::string folder_;
  FmuInterface interface_;
  std::unique_ptr<const ModelFile> file_;
  std::vector<FmuVariable> variables_;
  FmuState state_;
  std::string start_warning_ = {};
  std::unique_ptr<Built> built_;
  /// The point inside a step at which the importer is being called.
  struct {
    const Assembler* assembler = nullptr;
    const State* state = nullptr;
  } inside_;
};

}  // namespace drev::app
