/* Functions of FMI 3.0 that a library must have and these models do not offer: they return fmi3Error or NULL. */

#define UNSUPPORTED(name) __attribute__((visibility("default"))) int name(void) { return 3; }
#define NO_INSTANCE(name) __attribute__((visibility("default"))) void *name(void) { return (void *)0; }
#define NO_TYPE(Type) UNSUPPORTED(fmi3Get##Type) UNSUPPORTED(fmi3Set##Type)

NO_INSTANCE(fmi3InstantiateModelExchange)
NO_INSTANCE(fmi3InstantiateScheduledExecution)

NO_TYPE(Int8)
NO_TYPE(UInt8)
NO_TYPE(Int16)
NO_TYPE(UInt16)
NO_TYPE(UInt32)
NO_TYPE(Int64)
NO_TYPE(UInt64)
NO_TYPE(Binary)
NO_TYPE(Clock)
NO_TYPE(IntervalDecimal)
NO_TYPE(IntervalFraction)
NO_TYPE(ShiftDecimal)
NO_TYPE(ShiftFraction)
NO_TYPE(ContinuousStates)

UNSUPPORTED(fmi3GetNumberOfVariableDependencies)
UNSUPPORTED(fmi3GetVariableDependencies)
UNSUPPORTED(fmi3GetAdjointDerivative)
UNSUPPORTED(fmi3EnterConfigurationMode)
UNSUPPORTED(fmi3ExitConfigurationMode)
UNSUPPORTED(fmi3EvaluateDiscreteStates)
UNSUPPORTED(fmi3EnterContinuousTimeMode)
UNSUPPORTED(fmi3CompletedIntegratorStep)
UNSUPPORTED(fmi3SetTime)
UNSUPPORTED(fmi3GetContinuousStateDerivatives)
UNSUPPORTED(fmi3GetEventIndicators)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates)
UNSUPPORTED(fmi3GetNumberOfEventIndicators)
UNSUPPORTED(fmi3GetNumberOfContinuousStates)
UNSUPPORTED(fmi3ActivateModelPartition)
