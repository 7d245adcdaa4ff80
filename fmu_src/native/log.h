/* The log of an instance, and texts of bounded length. */

#ifndef LOG_H
#define LOG_H

#include "instance.h"

#if defined(__GNUC__)
#define LIKE_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define LIKE_PRINTF(text, first)
#endif

enum { LONGEST = 1536 }; /* bytes of the longest message */

typedef struct {
    char text[LONGEST];
    size_t size;
} Text;

/* Extend a text; what is too long is cut. */
void text_add(Text *text, const char *format, ...) LIKE_PRINTF(2, 3);

/* Choose the entries sent to the host: all, those of the given categories, or none. Errors are always sent, warnings
   until the host has asked for none. */
void log_choose(Instance *it, int on, size_t count, const char *const categories[]);
void log_text(const Instance *it, Status status, Category category, const char *text);
/* Log an error, and return ERROR. */
Status log_error(const Instance *it, const char *format, ...) LIKE_PRINTF(2, 3);

#endif
