#pragma once
/// An instance of an FMU, whatever the version of FMI: the model with its inputs, its state, and the steps that
/// exact propagation takes. Wrong use throws FmuError, a wrong model ModelError, a failed computation SolverError;
/// the instance is then as before the call.
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

/// What an importer wishes for in a step.
struct FmuStepWishes {
  bool end_at_change = false;  ///< end it where a contact changes
  /// Called inside the step: real() then gives outputs there, and nothing may be set.
  std::function<void(double t)> inside = {};
};
struct FmuStepped {
  std::string warning = {};  ///< or nothing
  bool at_change = false;    ///< it ended ahead of its time, at a contact change
};

class FmuInstance {
 public:
  /// Of the folder that holds interface.toml. Builds the model with the parameters' start values.
  explicit FmuInstance(const std::string& resources);
  ~FmuInstance();
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;

  const FmuInterface& interface() const { return interface_; }
  /// By value reference.
  const std::vector<FmuVariable>& variables() const { return variables_; }
  const std::vector<Parameter>& parameters() const;
  const ModelCase& model_case() const;
  /// The real parameters that may change while a simulation runs: those with which unknowns, nominal and prescribed
  /// motions and initial conditions stay what they are. Tried with values near the start values.
  std::vector<std::string> find_tunable() const;
  FmuMode mode() const { return state_.mode; }

  /// Values by value reference; throws FmuError for one that there is not, or that is of another type.
  double real(unsigned reference);
  int integer(unsigned reference) const;
  const std::string& text(unsigned reference) const;
  /// Throws FmuError where one of them cannot be set now; none is set then.
  void set_reals(const unsigned* references, const double* values, std::size_t count);
  void set_integers(const unsigned* references, const int* values, std::size_t count);
  void set_texts(const unsigned* references, const std::vector<std::string>& values);
  /// The first derivative of an input over the next step, 1/s of its unit.
  void set_input_slopes(const unsigned* references, const double* values, std::size_t count);

  /// tolerance: relative, 0: the default; t_stop <= t_start: there is none. s.
  void enter_initialization(double t_start, double t_stop, double tolerance);
  void exit_initialization();
  /// From t over h [s], or to the first contact change if that is wished for.
  FmuStepped step(double t, double h, const FmuStepWishes& wishes = {});
  /// sum_j (dy_i/du_j) seed_j of outputs y by inputs u, where the motion has come to, with the inputs as they are set: what
  /// follows an input at once (accelerations, reactions, forces of dampers beside a speed). By central differences,
  /// which are exact except for rounding where the law is linear.
  std::vector<double> directional_derivative(const std::vector<unsigned>& unknowns,
                                             const std::vector<unsigned>& knowns,
                                             const std::vector<double>& seed);
  void terminate();
  void reset();

  const FmuState& state() const { return state_; }
  /// Throws for a state of another model.
  void set_state(const FmuState& state);

 private:
  struct Built;
  class Inside;

  const FmuVariable& variable(unsigned reference, FmuVariable::Type type) const;
  const FmuVariable& settable(unsigned reference, FmuVariable::Type type) const;
  void require(bool right, const char* call, const char* when) const;
  void set_parameters(const std::vector<std::pair<std::size_t, std::string>>& values);
  std::unique_ptr<Built> build(const std::vector<std::string>& parameters) const;
  /// Finds the state that the model starts from, with the inputs as they are.
  void start();
  void hand_inputs_on();
  void find_acceleration();
  double reached(const SpeedInput& input, std::size_t i, double t) const;
  std::optional<double> first_change(const ExactOptions& options);
  double output(std::size_t place);

  std::string folder_;
  FmuInterface interface_;
  std::unique_ptr<const ModelFile> file_;
  std::vector<FmuVariable> variables_;
  FmuState state_;
  std::unique_ptr<Built> built_;
  /// The point inside a step that the importer is being shown.
  struct {
    const Assembler* assembler = nullptr;
    const State* state = nullptr;
  } inside_;
};

}  // namespace drev::app
