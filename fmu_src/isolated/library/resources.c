#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "channel.h"
#include "python.h"

static int holds_start(const char *folder) {
    char *file = joined(folder, "start.py");
    int found = file && readable(file);
    free(file);
    return found;
}

/* <folder>/binaries/<platform>/<this library> -> <folder>/resources */
static char *beside_library(void) {
    char *path = library_path();
    for (int up = 0; path && up < 3; up++) {
        size_t end = strlen(path);
        while (end > 0 && path[end - 1] != '/' && path[end - 1] != '\\') end--;
        path[end > 0 ? end - 1 : 0] = 0;
    }
    char *folder = path ? joined(path, "resources") : NULL;
    free(path);
    return folder;
}

char *channel_resources(const char *place, Reason *why) {
    const char *given = place ? place : "";
    char *folder = beside_library();
    if (folder && holds_start(folder)) return folder;
    free(folder);
    folder = strncmp(given, "file:", 5) ? strdup(given) : path_of_uri(given);
    if (folder && holds_start(folder)) return folder;
    free(folder);
    snprintf(why->text, sizeof why->text,
             "The FMU's resources are neither beside its library nor at '%s'. Unpack the whole FMU and keep its "
             "folders together.",
             given);
    return NULL;
}
