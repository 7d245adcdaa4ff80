/* What the two files of FMI 3.0's functions share. */

#ifndef FMI3_H
#define FMI3_H

#include "fmi3Functions.h"
#include "instance.h"

/* Some hosts call with freed instances: such a call is an error, not a crash. */
#define INSTANCE(c)          \
    Instance *instance = c; \
    if (!instance_known(instance)) return fmi3Error

/* A host that gives NULL for an array that is not empty, or for a place where to write, gets an error. */
#define GIVEN(count, first, second) \
    if (instance_lacks(instance, count, first, second)) return fmi3Error

#define STATUS(status) ((fmi3Status)(status)) /* an instance has FMI 2.0's, of the same values */

/* Log that the call `what` is not supported, and return fmi3Error. */
fmi3Status fmi3_unsupported(fmi3Instance instance, const char *what);

#endif
