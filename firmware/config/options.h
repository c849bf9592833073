/* The command line of ale-slamd. */
#ifndef ALE_FIRMWARE_CONFIG_OPTIONS_H
#define ALE_FIRMWARE_CONFIG_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "command/keys.h"
#include "config/config.h"

typedef enum {
    ALE_OPTIONS_RUN,
    ALE_OPTIONS_DONE,   /* --help, --version, --print-config, --check-config: was all that was wanted */
    ALE_OPTIONS_REFUSED /* one line on stderr has said why: exit 2 */
} ale_options_result_t;

typedef struct {
    ale_config_t config; /* the file's, with what the command line sets over it */
    ale_keys_t keys;     /* of those who may command the robot */
    bool vouches;        /* own_key is set */
    ale_secret_key_t own_key;
    bool keyed; /* drive_key is set */
    ale_drive_key_t drive_key;
    int32_t scale_ppm; /* of the clock */
} ale_options_t;

/* Answers go to `out`, messages to stderr. */
ale_options_result_t ale_options_read(int count, char **words, ale_options_t *options, FILE *out);

#endif
