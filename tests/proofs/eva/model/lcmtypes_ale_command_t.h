/* The command as LCM's generator declares it (lib/messages/ale.lcm), without LCM. */
#ifndef ALE_PROOFS_EVA_LCMTYPES_ALE_COMMAND_T_H
#define ALE_PROOFS_EVA_LCMTYPES_ALE_COMMAND_T_H

#include <stdint.h>

typedef struct {
    int64_t utime;
    int64_t expiry_utime;
    int64_t boot;
    int64_t counter;
    char *robot;
    char *operator_name;
    char *verb;
    int32_t num_args;
    char **args;
    int32_t num_signature;
    uint8_t *signature;
} lcmtypes_ale_command_t;

int64_t __lcmtypes_ale_command_t_get_hash(void);
int lcmtypes_ale_command_t_encode(void *bytes, int offset, int most, const lcmtypes_ale_command_t *message);

#endif
