#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include "python.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

wchar_t *wide(const char *text) {
    int length = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
    wchar_t *copy = length > 0 ? malloc((size_t)length * sizeof *copy) : NULL;
    if (copy) MultiByteToWideChar(CP_UTF8, 0, text, -1, copy, length);
    return copy;
}

char *narrow(const wchar_t *text) {
    int length = WideCharToMultiByte(CP_UTF8, 0, text, -1, NULL, 0, NULL, NULL);
    char *copy = length > 0 ? malloc((size_t)length) : NULL;
    if (copy) WideCharToMultiByte(CP_UTF8, 0, text, -1, copy, length, NULL, NULL);
    return copy;
}

const char *meaning(unsigned long code, char text[256]) {
    wchar_t said[256] = L"";
    DWORD length = FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, NULL, code, 0, said, 256,
                                  NULL);
    while (length > 0 && wcschr(L"\r\n .", said[length - 1])) said[--length] = 0;
    char *plain = length > 0 ? narrow(said) : NULL;
    snprintf(text, 256, "Windows error %lu%s%s", code, plain ? ": " : "", plain ? plain : "");
    free(plain);
    return text;
}

char *joined(const char *folder, const char *name) {
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s\\%s", folder, name);
    return path;
}

/* file:///C:/folder and file:/C:/folder mean C:/folder; file://server/folder means //server/folder. */
char *path_of_uri(const char *uri) {
    if (strncmp(uri, "file:", 5)) return NULL;
    uri += 5;
    if (!strncmp(uri, "///", 3)) uri += 2;
    if (uri[0] == '/' && uri[1] != '/') uri++;
    char *path = malloc(strlen(uri) + 1), *to = path;
    while (path && *uri) {
        unsigned value;
        int escaped = sscanf(uri, "%%%2x", &value) == 1;
        *to++ = escaped ? (char)value : *uri;
        uri += escaped ? 3 : 1;
    }
    if (path) *to = 0;
    return path;
}

/* Value of an environment variable, to be freed; NULL if empty. Not by getenv: the host may use another C library. */
static wchar_t *variable(const wchar_t *name) {
    DWORD size = GetEnvironmentVariableW(name, NULL, 0);
    wchar_t *value = size > 1 ? malloc(size * sizeof *value) : NULL;
    if (value) GetEnvironmentVariableW(name, value, size);
    return value;
}

/* Full path of a program, searched along PATH only: Windows would begin in the host's folders. */
static char *program(const char *name) {
    wchar_t *folders = variable(L"PATH"), *called = wide(name), *path = NULL;
    const wchar_t *searched = folders ? folders : L"";
    char *found = NULL;
    DWORD size = called ? SearchPathW(searched, called, L".exe", 0, NULL, NULL) : 0;
    if (size) path = malloc(size * sizeof *path);
    if (path && SearchPathW(searched, called, L".exe", size, path, NULL)) found = narrow(path);
    free(folders);
    free(called);
    free(path);
    return found;
}

static char *chosen(const char *name, const char *where, Reason *why) {
    char text[256], *found = program(name);
    if (!found)
        snprintf(why->text, sizeof why->text, "%s names the Python '%s', which cannot be run (%s). %s", where, name,
                 meaning(GetLastError(), text), PYTHON_HINT);
    return found;
}

/* The first line of python.txt, if it is there. */
static int recorded(const char *resources, char *path, int room) {
    char *name = joined(resources, "python.txt");
    wchar_t *wide_name = name ? wide(name) : NULL;
    FILE *file = wide_name ? _wfopen(wide_name, L"rb") : NULL;
    int found = file && fgets(path, room, file) != NULL;
    if (found) path[strcspn(path, "\r\n")] = 0;
    if (file) fclose(file);
    free(wide_name);
    free(name);
    return found;
}

char *interpreter(const char *resources, Reason *why) {
    char path[4096], *found = NULL;
    wchar_t *asked = variable(L"TRIBOFMU_PYTHON");
    char *wish = asked ? narrow(asked) : NULL;
    int named = !wish && recorded(resources, path, sizeof path);
    if (wish)
        found = chosen(wish, "TRIBOFMU_PYTHON", why);
    else if (named)
        found = chosen(path, "The FMU", why);
    if (!found && !wish && !(found = program("python.exe")) && !(found = program("python3.exe")) && !named)
        snprintf(why->text, sizeof why->text, "There is no python.exe on PATH. %s", PYTHON_HINT);
    free(wish);
    free(asked);
    return found;
}

wchar_t *clean_environment(void) {
    /* the last one is set in a host that is the Python of a virtual environment, and would take effect */
    static const wchar_t *const foreign[] = {L"PYTHON", L"__PYVENV_LAUNCHER__="};
    wchar_t *all = GetEnvironmentStringsW(), *end = all;
    while (end && *end) end += wcslen(end) + 1;
    wchar_t *clean = all ? malloc((size_t)(end - all + 2) * sizeof *clean) : NULL, *to = clean;
    for (wchar_t *from = all; clean && *from; from += wcslen(from) + 1) {
        int drop = 0;
        for (size_t k = 0; k < sizeof foreign / sizeof *foreign; k++)
            drop |= !_wcsnicmp(from, foreign[k], wcslen(foreign[k]));
        if (!drop) to = wcscpy(to, from) + wcslen(from) + 1;
    }
    if (clean) to[0] = to[1] = 0;
    if (all) FreeEnvironmentStringsW(all);
    return clean;
}

int readable(const char *path) {
    wchar_t *wide_path = wide(path);
    int found = wide_path && GetFileAttributesW(wide_path) != INVALID_FILE_ATTRIBUTES;
    free(wide_path);
    return found;
}

char *library_path(void) {
    enum { LONGEST = 32768 };
    const DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    HMODULE library;
    wchar_t *path = malloc(LONGEST * sizeof *path);
    char *found = NULL;
    if (path && GetModuleHandleExW(flags, (LPCWSTR)(const void *)&library_path, &library) &&
        GetModuleFileNameW(library, path, LONGEST))
        found = narrow(path);
    free(path);
    return found;
}

void *library_keep(void) {
    static const char here;
    HMODULE module;
    return GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS, (const wchar_t *)&here, &module) ? module : NULL;
}

void library_release(void *kept) {
    if (kept) FreeLibrary(kept);
}
