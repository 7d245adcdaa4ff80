/* What the runtime knows of one contact: its variables by value reference, its identity and its flags. model.c is
   generated for a scene, as contact.c is. */

#ifndef MODEL_H
#define MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "contact.h"

typedef enum { REAL, INTEGER, BOOLEAN, STRING } Kind;

/* DERIVATIVE: an output that contact_derivatives makes; VALID, FIDELITY_USED: outputs that the runtime makes. */
typedef enum { INPUT, FIXED, OUTPUT, DERIVATIVE, VALID, FIDELITY_USED, TIME } Role;

typedef enum { OF_WARNINGS, OF_ERRORS, OF_VALIDITY, OF_SOLVER, CATEGORIES } Category;

/* Places count doubles from the beginning of contact_inputs or contact_outputs. */
/* Of names without brackets: load_1 for load[1]. */
#define PLACE_OF_INPUT(name) (offsetof(contact_inputs, name) / sizeof(double))
#define PLACE_OF_OUTPUT(name) (offsetof(contact_outputs, name) / sizeof(double))

enum {
    INPUTS = sizeof(contact_inputs) / sizeof(double),
    OUTPUTS = sizeof(contact_outputs) / sizeof(double),
    TOKEN = 40 /* bytes of the longest of both tokens, NUL included */
};

typedef struct {
    const char *name;
    Kind kind;
    Role role;
    size_t place; /* of inputs, and of outputs that lie in contact_outputs */
    double start; /* of inputs and parameters; a String starts empty */
} Variable;

/* An input: its range, both ends included, and its magnitude, by which the steps of differences are chosen. */
typedef struct {
    const char *name, *text, *unit;
    size_t place;
    double minimum, maximum, nominal;
} Input;

/* A bit of range_flags. */
typedef struct {
    uint32_t value;
    Category category;
    const char *text;
} Flag;

/* An output that is the derivative of friction_force by an input. */
typedef struct {
    size_t output, input;
} Derivative;

extern const char MODEL_TOKEN[TOKEN];
extern const char MODEL_STATES[TOKEN]; /* in stored states: the same by FMI 2 and FMI 3 */
extern const double MODEL_FIDELITY; /* level that gives the outputs */
extern const int MODEL_FOLLOWS;     /* outputs follow inputs without a step between */
extern const Variable MODEL_VARIABLES[];
extern const size_t MODEL_VARIABLES_COUNT;
extern const Input MODEL_INPUTS[INPUTS];
extern const Derivative MODEL_DERIVATIVES[];
extern const size_t MODEL_DERIVATIVES_COUNT;
extern const size_t MODEL_FRICTION_FORCE, MODEL_RANGE_FLAGS; /* places; OUTPUTS: there is none */
extern const Flag MODEL_FLAGS[];
extern const size_t MODEL_FLAGS_COUNT;
extern const char *const MODEL_CATEGORIES[CATEGORIES];

#endif
