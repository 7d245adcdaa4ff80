/* The interpreter that runs the model, its environment, and paths. */

#ifndef PYTHON_H
#define PYTHON_H

#include "channel.h"

#define PYTHON_HINT "Set TRIBOFMU_PYTHON to the Python of an environment in which tribofmu is installed."

/* Path of the interpreter: TRIBOFMU_PYTHON, else what python.txt in the resources says, else python3 on PATH. To be
   freed by the caller; NULL and a reason if there is none. */
char *interpreter(const char *resources, Reason *why);

/* The environment without what is meant for the host's own Python and libraries; one block, to be freed. */
char **clean_environment(void);

/* folder/name, to be freed; NULL without memory. */
char *joined(const char *folder, const char *name);

/* The path that a file URI means, to be freed; NULL if it is none. */
char *path_of_uri(const char *uri);

#endif
