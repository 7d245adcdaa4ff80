#include "python.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern char **environ;

char *joined(const char *folder, const char *name) {
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s", folder, name);
    return path;
}

static int digit(char c) {
    const char *digits = "0123456789abcdef", *found = c ? strchr(digits, c | ('A' <= c && c <= 'F' ? 32 : 0)) : NULL;
    return found ? (int)(found - digits) : -1;
}

char *path_of_uri(const char *uri) {
    if (strncmp(uri, "file:", 5)) return NULL;
    uri += 5;
    if (!strncmp(uri, "//", 2) && !(uri = strchr(uri + 2, '/'))) return NULL; /* a file on another machine */
    char *path = malloc(strlen(uri) + 1), *to = path;
    for (; path && *uri; uri++) {
        int high = *uri == '%' ? digit(uri[1]) : -1, low = high >= 0 ? digit(uri[2]) : -1;
        *to++ = low < 0 ? *uri : (char)(16 * high + low);
        if (low >= 0) uri += 2;
    }
    if (path) *to = 0;
    return path;
}

static int runs(const char *path) {
    struct stat found;
    if (stat(path, &found)) return 0;
    errno = EACCES;
    return S_ISREG(found.st_mode) && faccessat(AT_FDCWD, path, X_OK, AT_EACCESS) == 0;
}

static char *on_path(const char *name) {
    const char *folders = getenv("PATH");
    char *list = strdup(folders ? folders : "/usr/local/bin:/usr/bin:/bin"), *rest = list, *found = NULL;
    for (char *folder; list && !found && (folder = strsep(&rest, ":"));) {
        found = joined(*folder ? folder : ".", name);
        if (found && !runs(found)) {
            free(found);
            found = NULL;
        }
    }
    free(list);
    if (!found) errno = ENOENT;
    return found;
}

static char *chosen(const char *path, const char *where, Reason *why) {
    char *found = strchr(path, '/') ? (runs(path) ? strdup(path) : NULL) : on_path(path);
    if (!found)
        snprintf(why->text, sizeof why->text, "%s names the Python '%s', which cannot be run (%s). %s", where, path,
                 strerror(errno), PYTHON_HINT);
    return found;
}

/* The first line of python.txt, if it is there. */
static int recorded(const char *resources, char *path, int room) {
    char *name = joined(resources, "python.txt");
    FILE *file = name ? fopen(name, "re") : NULL;
    int found = file && fgets(path, room, file) != NULL;
    if (found) path[strcspn(path, "\r\n")] = 0;
    if (file) fclose(file);
    free(name);
    return found;
}

char *interpreter(const char *resources, Reason *why) {
    char path[4096];
    const char *variable = getenv("TRIBOFMU_PYTHON");
    if (variable && *variable) return chosen(variable, "TRIBOFMU_PYTHON", why);
    int named = recorded(resources, path, sizeof path);
    char *found = named ? chosen(path, "The FMU", why) : NULL;
    if (!found) found = on_path("python3"); /* the recorded one may be that of another machine */
    if (!found && !named) snprintf(why->text, sizeof why->text, "There is no python3 on PATH. %s", PYTHON_HINT);
    return found;
}

char **clean_environment(void) {
    static const char *const foreign[] = {"PYTHON", "LD_PRELOAD=", "LD_LIBRARY_PATH="};
    size_t count = 0, kept = 0;
    while (environ && environ[count]) count++;
    char **clean = malloc((count + 1) * sizeof *clean);
    for (size_t i = 0; clean && i < count; i++) {
        int drop = 0;
        for (size_t k = 0; k < sizeof foreign / sizeof *foreign; k++)
            drop |= !strncmp(environ[i], foreign[k], strlen(foreign[k]));
        if (!drop) clean[kept++] = environ[i];
    }
    if (clean) clean[kept] = NULL;
    return clean;
}

int readable(const char *path) { return access(path, R_OK) == 0; }

/* Determined when the library is loaded: its name may be relative to the working folder at that time. */
static char *library, *name_of_library;

__attribute__((constructor)) static void loaded(void) {
    Dl_info info;
    if (!dladdr((void *)&library, &info)) return;
    library = realpath(info.dli_fname, NULL);
    name_of_library = strdup(info.dli_fname);
}

__attribute__((destructor)) static void unloaded(void) {
    free(library);
    free(name_of_library);
}

void *library_keep(void) { return name_of_library ? dlopen(name_of_library, RTLD_LAZY | RTLD_NOLOAD) : NULL; }

void library_release(void *kept) {
    if (kept) dlclose(kept);
}

char *library_path(void) { return library ? strdup(library) : NULL; }
