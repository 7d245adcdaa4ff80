/* What c_host.c takes from POSIX and Windows has under other names. */

#ifndef DLFCN_H
#define DLFCN_H

#include <windows.h>

#include <stdio.h>
#include <sys/types.h>

enum { RTLD_NOW, RTLD_LOCAL };

static inline void *dlopen(const char *path, int mode)
{
    wchar_t wide[MAX_PATH];
    (void)mode;
    return MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, MAX_PATH) ? LoadLibraryW(wide) : NULL;
}

static inline void *dlsym(void *library, const char *name)
{
    return (void *)GetProcAddress(library, name);
}

static inline int dlclose(void *library)
{
    return !FreeLibrary(library);
}

static inline const char *dlerror(void)
{
    static char text[32];
    snprintf(text, sizeof text, "Windows error %lu", GetLastError());
    return text;
}

static inline pid_t fork(void)
{
    return -1; /* there is none */
}

static inline int pause(void)
{
    return -1;
}

#endif
