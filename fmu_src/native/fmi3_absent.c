/* The functions of FMI 3.0 that a library must have and this FMU does not offer: other kinds of numbers, binaries,
   clocks, events and model exchange. */

#include "fmi3Functions.h"
#include "log.h"

static fmi3Status absent(fmi3Instance instance, const char *what) {
    if (!instance) return fmi3Error;
    return (fmi3Status)log_error(instance, "%s is not supported: see the capabilities in modelDescription.xml.", what);
}

/* A call for no variables at all is no mistake. */
#define NO_NUMBERS(Type)                                                                                          \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3##Type value[],       \
                             size_t nValues) {                                                                    \
        (void)vr, (void)value, (void)nValues;                                                                     \
        return c && !nvr ? fmi3OK : absent(c, "fmi3Get" #Type);                                                   \
    }                                                                                                             \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3##Type value[], \
                             size_t nValues) {                                                                    \
        (void)vr, (void)value, (void)nValues;                                                                     \
        return c && !nvr ? fmi3OK : absent(c, "fmi3Set" #Type);                                                   \
    }

NO_NUMBERS(Float32)
NO_NUMBERS(Int8)
NO_NUMBERS(UInt8)
NO_NUMBERS(Int16)
NO_NUMBERS(UInt16)
NO_NUMBERS(UInt32)
NO_NUMBERS(Int64)
NO_NUMBERS(UInt64)

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, size_t sizes[], fmi3Binary value[],
                         size_t nValues) {
    (void)vr, (void)sizes, (void)value, (void)nValues;
    return c && !nvr ? fmi3OK : absent(c, "fmi3GetBinary");
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const size_t sizes[],
                         const fmi3Binary value[], size_t nValues) {
    (void)vr, (void)sizes, (void)value, (void)nValues;
    return c && !nvr ? fmi3OK : absent(c, "fmi3SetBinary");
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t nValues) {
    (void)vr, (void)orders, (void)values, (void)nValues;
    return c && !nvr ? fmi3OK : absent(c, "fmi3GetOutputDerivatives");
}

/* clocks */

#define CLOCK(Name, Values)                                                                      \
    fmi3Status fmi3##Name(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, Values) { \
        (void)vr, (void)values;                                                                  \
        return c && !nvr ? fmi3OK : absent(c, "fmi3" #Name);                                     \
    }

CLOCK(GetClock, fmi3Clock values[])
CLOCK(SetClock, const fmi3Clock values[])
CLOCK(GetShiftDecimal, fmi3Float64 values[])
CLOCK(SetShiftDecimal, const fmi3Float64 values[])
CLOCK(SetIntervalDecimal, const fmi3Float64 values[])

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3Float64 intervals[],
                                  fmi3IntervalQualifier qualifiers[]) {
    (void)vr, (void)nvr, (void)intervals, (void)qualifiers;
    return absent(c, "fmi3GetIntervalDecimal");
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3UInt64 counters[],
                                   fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]) {
    (void)vr, (void)nvr, (void)counters, (void)resolutions, (void)qualifiers;
    return absent(c, "fmi3GetIntervalFraction");
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr,
                                   const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    (void)vr, (void)nvr, (void)counters, (void)resolutions;
    return absent(c, "fmi3SetIntervalFraction");
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3UInt64 counters[],
                                fmi3UInt64 resolutions[]) {
    (void)vr, (void)nvr, (void)counters, (void)resolutions;
    return absent(c, "fmi3GetShiftFraction");
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3UInt64 counters[],
                                const fmi3UInt64 resolutions[]) {
    (void)vr, (void)nvr, (void)counters, (void)resolutions;
    return absent(c, "fmi3SetShiftFraction");
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clockReference, fmi3Float64 activationTime) {
    (void)clockReference, (void)activationTime;
    return absent(c, "fmi3ActivateModelPartition");
}

/* events */

#define PLAIN(Name) \
    fmi3Status fmi3##Name(fmi3Instance c) { return absent(c, "fmi3" #Name); }

PLAIN(EnterEventMode)
PLAIN(EnterStepMode)
PLAIN(EvaluateDiscreteStates)
PLAIN(EnterContinuousTimeMode)

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
                                    fmi3Float64 *nextEventTime) {
    (void)discreteStatesNeedUpdate, (void)terminateSimulation, (void)nominalsOfContinuousStatesChanged;
    (void)valuesOfContinuousStatesChanged, (void)nextEventTimeDefined, (void)nextEventTime;
    return absent(c, "fmi3UpdateDiscreteStates");
}

/* model exchange */

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint, (void)enterEventMode, (void)terminateSimulation;
    return absent(c, "fmi3CompletedIntegratorStep");
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    (void)time;
    return absent(c, "fmi3SetTime");
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 continuousStates[], size_t nContinuousStates) {
    (void)continuousStates, (void)nContinuousStates;
    return absent(c, "fmi3SetContinuousStates");
}

#define NO_STATES(Name)                                                              \
    fmi3Status fmi3Get##Name(fmi3Instance c, fmi3Float64 values[], size_t count) { \
        (void)values, (void)count;                                                   \
        return absent(c, "fmi3Get" #Name);                                           \
    }

NO_STATES(ContinuousStateDerivatives)
NO_STATES(EventIndicators)
NO_STATES(ContinuousStates)
NO_STATES(NominalsOfContinuousStates)

#define NO_COUNT(Name)                                             \
    fmi3Status fmi3GetNumberOf##Name(fmi3Instance c, size_t *count) { \
        (void)count;                                               \
        return absent(c, "fmi3GetNumberOf" #Name);                 \
    }

NO_COUNT(EventIndicators)
NO_COUNT(ContinuousStates)
