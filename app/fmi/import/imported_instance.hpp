#pragma once
/// An instance of another tool's FMU for co-simulation, for FMI 2.0 and 3.0. Its library runs in this
/// process. Errors are std::runtime_error with the FMU, the call, the variable, and the messages that the FMU
/// logged.
#include <memory>
#include <string>

#include "app/fmi/import/unpacked_fmu.hpp"

namespace drev::app {

class ImportedInstance {
 public:
  virtual ~ImportedInstance() = default;
  /// Sets a real, integer or boolean variable (0 is false).
  virtual void set(const ImportedVariable& variable, double value) = 0;
  virtual void set_text(const ImportedVariable& variable, const std::string& value) = 0;
  /// FMI 2: sets the time derivative of an input over the next step [unit of the input per s].
  virtual void set_slope(const ImportedVariable& variable, double slope) = 0;
  virtual double get(const ImportedVariable& variable) = 0;
  virtual void enter_initialization(double t_start, double t_end) = 0;
  virtual void exit_initialization() = 0;
  /// A step from t over h [s].
  virtual void step(double t, double h) = 0;
  /// The first call that the FMU answered with a warning, with what it logged, and how many there were; empty: none.
  virtual std::string warning() const = 0;
};

std::unique_ptr<ImportedInstance> instantiate(std::shared_ptr<const UnpackedFmu> fmu,
                                              const std::string& name);

}  // namespace drev::app
