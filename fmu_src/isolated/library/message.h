/* Messages between host and worker. message.py and worker.py are the other side; change them together.

   Numbers are little-endian; every item begins at a multiple of 8 bytes.

   request: struct request, `forgotten` state numbers (uint64), `sets` records, then `payload` bytes
   answer:  struct answer, `outputs` values (double) of the outputs in order of their references,
            `logs` entries (struct entry, category, message), then the results of the operation

   record:  struct record; for a string its `value` is a length in bytes, and the text follows, padded to 8 */

#ifndef MESSAGE_H
#define MESSAGE_H

#include <stdint.h>

enum operation {
    OPEN = 1,  /* payload: instance name, NUL, guid; returns the table: uint64 count, a record for every variable */
    SETUP,     /* numbers: start time, stop time or NaN, tolerance or NaN */
    ENTER,     /* enter initialisation mode */
    EXIT,      /* exit initialisation mode */
    STEP,      /* numbers: time, step */
    LOOK,      /* bring outputs up to date; returns the table */
    TERMINATE,
    RESET,     /* returns the table */
    SAVE,      /* keep the state under the number `state`; returns its parts: uint64 count, for each struct part,
                  then the bytes of those that are new, each padded to 8 */
    RESTORE,   /* the state with the number `state`, or, if it is 0, the one in the payload; returns the table. A state
                  whose values the host has kept needs none: the next request goes `back` to it */
    QUIT       /* end without an answer */
};

enum kind { REAL, INTEGER, BOOLEAN, STRING };

enum causality { INPUT, FIXED, TUNABLE, OUTPUT, DIRECT }; /* direct: an input that outputs depend on at once */

struct request {
    uint32_t operation, sets;
    uint64_t forgotten;
    uint64_t back; /* number of a state to restore first; 0: none */
    uint64_t state, payload;
    double numbers[3];
};

enum phase { NEW, INITIALISING, STEPPING };

struct answer {
    uint32_t status, phase; /* fmi2Status; phase of the model */
    uint64_t outputs, logs;
};

struct entry {
    uint32_t status, category, message, unused; /* lengths in bytes; both texts end with NUL, padded to 8 together */
};

struct record {
    uint16_t kind, causality;
    uint32_t reference;
    double value;
};

struct part {
    uint64_t size;
    int64_t same; /* number of the same part in the state saved before, or -1: its bytes follow */
};

#endif
