/* The interpreter that runs the model, its environment, and paths. */

#ifndef PYTHON_H
#define PYTHON_H

#include "channel.h"

#define PYTHON_HINT "Set TRIBOFMU_PYTHON to the Python of an environment in which tribofmu is installed."

/* Path of the interpreter: TRIBOFMU_PYTHON, else what python.txt in the resources says, if that is on this machine, else
   python3 (on Windows python.exe, then python3.exe) on PATH. To be freed by the caller; NULL and a reason if there is none. */
char *interpreter(const char *resources, Reason *why);

/* The environment without variables for the host's own Python and libraries; one block, to be freed. */
#ifdef _WIN32
wchar_t *clean_environment(void);
#else
char **clean_environment(void);
#endif

/* folder/name, to be freed; NULL without memory. */
char *joined(const char *folder, const char *name);

/* The path of a file URI, to be freed; NULL if it is not a file URI. */
char *path_of_uri(const char *uri);

/* True if the file can be read. */
int readable(const char *path);

/* Path of this library, to be freed; NULL if it is unknown. */
char *library_path(void);

/* Keep this library loaded while an instance lives: some hosts unload it and load it again for the next instance. NULL
   if it cannot be kept. */
void *library_keep(void);

/* Release it. This must be the last call of the function called by the host, which the compiler then makes a jump:
   there may be no code left to return to. */
void library_release(void *library);

#ifdef _WIN32
/* Text is UTF-8 everywhere but in calls of Windows; both to be freed, NULL without memory. */
wchar_t *wide(const char *text);
char *narrow(const wchar_t *text);

/* Message of a Windows error code, at most 255 bytes. */
const char *meaning(unsigned long code, char text[256]);
#endif

#endif
