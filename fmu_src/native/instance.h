/* One contact in a host: its phase, inputs, state and outputs, its log and its saved states. Nothing is shared between
   instances, and after instance_new no memory is allocated, but for saved states beyond SLOTS. */

#ifndef INSTANCE_H
#define INSTANCE_H

#include "contact.h"
#include "model.h"

/* Equal to fmi2Status and fmi3Status. */
typedef enum { OK, WARNING, DISCARD, ERROR } Status;

typedef enum {
    NEW,
    CONFIGURING, /* FMI 3: between NEW and NEW */
    UNSETTLED,   /* in initialisation mode, outputs older than what they depend on */
    SETTLED,     /* in initialisation mode, outputs up to date */
    STEPPING,
    BEHIND /* after initialisation, an input has been set that outputs follow at once */
} Phase;

typedef struct {
    contact_state state;
    contact_outputs outputs;
} Solution;

/* All that an FMU state holds. Neither pointers nor padding: its bytes are the serialised state. */
typedef struct {
    contact_inputs inputs; /* as the host has set them */
    contact_inputs used;   /* those that the outputs belong to */
    Solution solution;
    double time, fidelity_used;
    uint32_t phase, valid;
    uint32_t ready;   /* the solution has a state */
    uint32_t derived; /* the derivative outputs are those of the solution */
} Moment;

typedef struct Instance Instance;

/* What FMI 2 and FMI 3 do differently. A callback of the host is kept as the generic pointer to a function. */
typedef struct Host {
    const char *prefix;     /* of the names of functions: "fmi2" */
    const char *experiment; /* function that sets start and stop time, without prefix */
    void (*deliver)(const struct Host *, const char *name, Status, const char *category, const char *message);
    void (*logger)(void);   /* NULL: none */
    void *environment;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
} Host;

/* A saved state; the address is the host's handle. */
typedef struct State {
    Moment moment;
    struct State *next; /* of those beyond the slots */
} State;

/* As many slots as leave an instance below 16 kB, two to eight. */
enum {
    MOST_SLOTS = 8,
    LEAST_SLOTS = 2,
    ROOM = (16384 - 512 - (int)(sizeof(Moment) + sizeof(Solution))) / (int)sizeof(State),
    SLOTS = ROOM > MOST_SLOTS ? MOST_SLOTS : ROOM < LEAST_SLOTS ? LEAST_SLOTS : ROOM
};

struct Instance {
    Moment now;
    Solution before; /* of the last call of the contact, to go back to if it fails */
    Host host;
    void (*update)(void); /* FMI 3: the host's intermediate update; NULL: none */
    int returns_early;    /* FMI 3: the host permits it */
    int asking;           /* the host is in its intermediate update: nothing may change */
    int terminated;
    int anywhere;         /* the next step may begin at any time; else at now.time */
    double stop;          /* NAN: none */
    enum { QUIET, USUAL, LOUD } logging; /* errors; warnings, too; all in `categories` */
    unsigned categories;                 /* bits by Category */
    unsigned taken;                      /* bits by slot */
    State *more;                         /* saved states beyond the slots */
    State slots[SLOTS];
    char name[]; /* of the instance */
};

/* life: instance.c */

/* NULL, and an entry in the log, if the token is another one's or there is no memory. */
Instance *instance_new(const Host *host, const char *name, const char *token, int logging);
void instance_free(Instance *it);
Status instance_set_up(Instance *it, double start, double stop);
Status instance_configure(Instance *it, int begin);
Status instance_enter(Instance *it);
Status instance_exit(Instance *it);
Status instance_terminate(Instance *it);
Status instance_reset(Instance *it);
/* Check a step, or advance by one that has been checked. */
Status instance_check_step(Instance *it, double time, double size);
Status instance_step(Instance *it, double time, double size);
/* Bring the outputs up to date, where they are older than what they depend on. */
Status instance_refresh(Instance *it);
/* True if each input can be used; each output is finite. */
int inputs_usable(const contact_inputs *inputs);
int outputs_finite(const contact_outputs *outputs);
/* OK, or ERROR with an entry in the log if one of both arrays of a call is NULL, and not empty. */
Status instance_check_arrays(const Instance *it, const char *call, size_t count, const void *first, const void *second);
/* OK, or ERROR with an entry in the log if the host may change nothing now. */
Status instance_may_change(Instance *it, const char *call);

/* variables: values.c */

Status instance_get(Instance *it, Kind kind, uint32_t reference, double *value);
Status instance_get_text(Instance *it, uint32_t reference, const char **text);
/* Check a value, or store one that has been checked. */
Status instance_check(Instance *it, Kind kind, uint32_t reference, double value);
Status instance_check_text(Instance *it, uint32_t reference, const char *text);
void instance_store(Instance *it, uint32_t reference, double value);
/* The variable of this kind; NULL with an entry in the log. */
const Variable *instance_variable(Instance *it, Kind kind, uint32_t reference);
int32_t instance_integer(double value);

/* saved states: states.c */

size_t instance_state_size(void);
Status instance_save(Instance *it, void **state);
Status instance_restore(Instance *it, void *state);
Status instance_forget(Instance *it, void **state);
void instance_forget_all(Instance *it);
Status instance_size(Instance *it, void *state, size_t *size);
Status instance_write(Instance *it, void *state, unsigned char *bytes, size_t size);
Status instance_read(Instance *it, const unsigned char *bytes, size_t size, void **state);

/* derivatives: derivatives.c */

/* Bring the derivative outputs up to date. */
Status instance_derive(Instance *it);
/* change[i] = sum over j of d unknown[i] / d known[j] * seed[j] */
Status instance_forward(Instance *it, const uint32_t unknown[], size_t unknowns, const uint32_t known[], size_t knowns,
                        const double seed[], double change[]);
/* change[j] = sum over i of seed[i] * d unknown[i] / d known[j] */
Status instance_backward(Instance *it, const uint32_t unknown[], size_t unknowns, const uint32_t known[], size_t knowns,
                         const double seed[], double change[]);

#endif
