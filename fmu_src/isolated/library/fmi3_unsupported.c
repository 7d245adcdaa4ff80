/* The functions of FMI 3.0 that this FMU does without: hosts look up the names, though they may not call them. */

#include "fmi3.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"

#define UNSUPPORTED(name, ...) \
    fmi3Status name(fmi3Instance instance, ##__VA_ARGS__) { return fmi3_unsupported(instance, #name); }

/* types of which the FMU has no variable: a host may ask for none of them */

#define REFERENCES const fmi3ValueReference vr[], size_t nvr
#define ABSENT(name, ...)                                                                            \
    fmi3Status name(fmi3Instance instance, REFERENCES, __VA_ARGS__) {                                \
        return nvr ? fmi3_unsupported(instance, #name) : instance_known(instance) ? fmi3OK : fmi3Error; \
    }
#define ABSENT_TYPE(Type)                                  \
    ABSENT(fmi3Get##Type, fmi3##Type values[], size_t n) \
    ABSENT(fmi3Set##Type, const fmi3##Type values[], size_t n)

ABSENT_TYPE(Float32)
ABSENT_TYPE(Int8)
ABSENT_TYPE(UInt8)
ABSENT_TYPE(Int16)
ABSENT_TYPE(UInt16)
ABSENT_TYPE(UInt32)
ABSENT_TYPE(Int64)
ABSENT_TYPE(UInt64)
ABSENT(fmi3GetBinary, size_t sizes[], fmi3Binary values[], size_t n)
ABSENT(fmi3SetBinary, const size_t sizes[], const fmi3Binary values[], size_t n)

/* clocks */

ABSENT(fmi3GetClock, fmi3Clock values[])
ABSENT(fmi3SetClock, const fmi3Clock values[])
ABSENT(fmi3GetIntervalDecimal, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
ABSENT(fmi3GetIntervalFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
ABSENT(fmi3GetShiftDecimal, fmi3Float64 shifts[])
ABSENT(fmi3GetShiftFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
ABSENT(fmi3SetIntervalDecimal, const fmi3Float64 intervals[])
ABSENT(fmi3SetIntervalFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
ABSENT(fmi3SetShiftDecimal, const fmi3Float64 shifts[])
ABSENT(fmi3SetShiftFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
UNSUPPORTED(fmi3ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 time)

/* dependencies and derivatives */

UNSUPPORTED(fmi3GetNumberOfVariableDependencies, fmi3ValueReference vr, size_t *count)
UNSUPPORTED(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t dependentElements[],
            fmi3ValueReference independents[], size_t independentElements[], fmi3DependencyKind kinds[], size_t count)
UNSUPPORTED(fmi3GetDirectionalDerivative, const fmi3ValueReference unknowns[], size_t nUnknowns,
            const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
            fmi3Float64 sensitivity[], size_t nSensitivity)
UNSUPPORTED(fmi3GetAdjointDerivative, const fmi3ValueReference unknowns[], size_t nUnknowns,
            const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
            fmi3Float64 sensitivity[], size_t nSensitivity)
ABSENT(fmi3GetOutputDerivatives, const fmi3Int32 orders[], fmi3Float64 values[], size_t n)

/* modes */

UNSUPPORTED(fmi3EnterConfigurationMode)
UNSUPPORTED(fmi3ExitConfigurationMode)
UNSUPPORTED(fmi3EnterEventMode)
UNSUPPORTED(fmi3EnterStepMode)
UNSUPPORTED(fmi3EvaluateDiscreteStates)
UNSUPPORTED(fmi3UpdateDiscreteStates, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals, fmi3Boolean *values,
            fmi3Boolean *hasNext, fmi3Float64 *next)

/* model exchange */

UNSUPPORTED(fmi3EnterContinuousTimeMode)
UNSUPPORTED(fmi3CompletedIntegratorStep, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *enterEventMode,
            fmi3Boolean *terminateSimulation)
UNSUPPORTED(fmi3SetTime, fmi3Float64 time)
UNSUPPORTED(fmi3SetContinuousStates, const fmi3Float64 states[], size_t n)
UNSUPPORTED(fmi3GetContinuousStates, fmi3Float64 states[], size_t n)
UNSUPPORTED(fmi3GetContinuousStateDerivatives, fmi3Float64 derivatives[], size_t n)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates, fmi3Float64 nominals[], size_t n)
UNSUPPORTED(fmi3GetEventIndicators, fmi3Float64 indicators[], size_t n)
UNSUPPORTED(fmi3GetNumberOfContinuousStates, size_t *n)
UNSUPPORTED(fmi3GetNumberOfEventIndicators, size_t *n)
