#include "log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void text_add_list(Text *text, const char *format, va_list arguments) {
    size_t room = sizeof text->text - text->size;
    int length = vsnprintf(text->text + text->size, room, format, arguments);
    if (length > 0) text->size += (size_t)length < room ? (size_t)length : room - 1;
}

void text_add(Text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    text_add_list(text, format, arguments);
    va_end(arguments);
}

void log_choose(Instance *it, int on, size_t count, const char *const categories[]) {
    unsigned every = (1u << CATEGORIES) - 1u;
    it->logging = on ? LOUD : QUIET;
    it->categories = count ? 0u : every;
    for (size_t i = 0; i < count; i++) {
        if (!categories[i]) continue;
        if (!strcmp(categories[i], "logAll")) it->categories = every;
        for (unsigned k = 0; k < CATEGORIES; k++)
            if (!strcmp(categories[i], MODEL_CATEGORIES[k])) it->categories |= 1u << k;
    }
}

static int heard(const Instance *it, Status status, Category category) {
    if (status >= ERROR) return 1;
    if (it->logging != LOUD) return it->logging == USUAL && status != OK;
    return (it->categories >> category & 1u) != 0u;
}

void log_text(const Instance *it, Status status, Category category, const char *text) {
    if (it->host.logger && heard(it, status, category))
        it->host.deliver(&it->host, it->name, status, MODEL_CATEGORIES[category], text);
}

Status log_error(const Instance *it, const char *format, ...) {
    Text text = {.size = 0};
    va_list arguments;
    va_start(arguments, format);
    text_add_list(&text, format, arguments);
    va_end(arguments);
    log_text(it, ERROR, OF_ERRORS, text.text);
    return ERROR;
}
