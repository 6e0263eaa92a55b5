// Functions of FMI 3.0 that every library must have and that this one answers with an error: model exchange,
// scheduled execution, clocks, arrays, and types that no variable of drev has.
#include "app/fmi/library/instances.hpp"

namespace {

using namespace drev::app;

int absent(void* instance, const char* call) {
  return guard(instance, call, [](Component&) -> Status {
    throw FmuError("this FMU for co-simulation has nothing that the function is for");
  });
}

}  // namespace

// The arguments past the instance are not read; by the calling convention of C the caller removes them.
#define DREV_ABSENT(name) \
  DREV_FMI int name(void* instance, ...) { return absent(instance, #name); }

// No variable has one of these types: an empty list is answered all the same.
#define DREV_NO_TYPE(name)                                                                         \
  DREV_FMI int name(void* instance, const std::uint32_t* /*references*/, std::size_t count, ...) { \
    if (count == 0) return guard(instance, #name, [](Component&) { return kOk; });                 \
    return absent(instance, #name);                                                                \
  }

DREV_FMI void* fmi3InstantiateModelExchange(const char* /*name*/, ...) { return nullptr; }
DREV_FMI void* fmi3InstantiateScheduledExecution(const char* /*name*/, ...) { return nullptr; }

DREV_NO_TYPE(fmi3GetFloat32)
DREV_NO_TYPE(fmi3GetInt8)
DREV_NO_TYPE(fmi3GetUInt8)
DREV_NO_TYPE(fmi3GetInt16)
DREV_NO_TYPE(fmi3GetUInt16)
DREV_NO_TYPE(fmi3GetUInt32)
DREV_NO_TYPE(fmi3GetInt64)
DREV_NO_TYPE(fmi3GetUInt64)
DREV_NO_TYPE(fmi3GetBoolean)
DREV_NO_TYPE(fmi3GetBinary)
DREV_NO_TYPE(fmi3GetClock)
DREV_NO_TYPE(fmi3SetFloat32)
DREV_NO_TYPE(fmi3SetInt8)
DREV_NO_TYPE(fmi3SetUInt8)
DREV_NO_TYPE(fmi3SetInt16)
DREV_NO_TYPE(fmi3SetUInt16)
DREV_NO_TYPE(fmi3SetUInt32)
DREV_NO_TYPE(fmi3SetInt64)
DREV_NO_TYPE(fmi3SetUInt64)
DREV_NO_TYPE(fmi3SetBoolean)
DREV_NO_TYPE(fmi3SetBinary)
DREV_NO_TYPE(fmi3SetClock)

DREV_ABSENT(fmi3GetNumberOfVariableDependencies)
DREV_ABSENT(fmi3GetVariableDependencies)
DREV_ABSENT(fmi3GetAdjointDerivative)
DREV_ABSENT(fmi3EnterConfigurationMode)
DREV_ABSENT(fmi3ExitConfigurationMode)
DREV_ABSENT(fmi3GetIntervalDecimal)
DREV_ABSENT(fmi3GetIntervalFraction)
DREV_ABSENT(fmi3GetShiftDecimal)
DREV_ABSENT(fmi3GetShiftFraction)
DREV_ABSENT(fmi3SetIntervalDecimal)
DREV_ABSENT(fmi3SetIntervalFraction)
DREV_ABSENT(fmi3SetShiftDecimal)
DREV_ABSENT(fmi3SetShiftFraction)
DREV_ABSENT(fmi3EvaluateDiscreteStates)
DREV_ABSENT(fmi3EnterContinuousTimeMode)
DREV_ABSENT(fmi3CompletedIntegratorStep)
DREV_ABSENT(fmi3SetTime)
DREV_ABSENT(fmi3SetContinuousStates)
DREV_ABSENT(fmi3GetContinuousStateDerivatives)
DREV_ABSENT(fmi3GetEventIndicators)
DREV_ABSENT(fmi3GetContinuousStates)
DREV_ABSENT(fmi3GetNominalsOfContinuousStates)
DREV_ABSENT(fmi3GetNumberOfEventIndicators)
DREV_ABSENT(fmi3GetNumberOfContinuousStates)
DREV_ABSENT(fmi3GetOutputDerivatives)
DREV_ABSENT(fmi3ActivateModelPartition)
