/* A command of an operator, as it is signed and checked; README.md lists the verbs. */
#ifndef ALE_COMMAND_COMMAND_H
#define ALE_COMMAND_COMMAND_H

#include <stdint.h>

enum {
    ALE_NAME_BYTES = 32, /* of an operator, a robot, a verb, with its end */
    ALE_COMMAND_ARGS = 8,
    ALE_COMMAND_ARG_BYTES = 64,
    ALE_SIGNATURE_BYTES = 64,
    ALE_COMMAND_BYTES = 1024 /* the longest message */
};

/* A command expires so long after the present at most: one that was held back is of no use for longer. */
enum { ALE_COMMAND_LIFE_US = 10000000 };

/* Times are utime of the robot's clock. Texts are printable ASCII. */
typedef struct {
    int64_t utime;
    int64_t expiry_utime;
    int64_t boot;
    int64_t counter; /* from 1; grows with every command of an operator */
    char robot[ALE_NAME_BYTES];
    char operator_name[ALE_NAME_BYTES];
    char verb[ALE_NAME_BYTES];
    uint32_t args;
    char arg[ALE_COMMAND_ARGS][ALE_COMMAND_ARG_BYTES];
} ale_command_t;

#endif
