/* Configuration of the robot: one INI file, a documented default for everything.
 *
 *   ale_config_t config = ale_config_default();
 *   ale_config_error_t error;
 *   if (ale_config_load("robot.ini", &config, &error) < 0) { fputs(error.message, stderr); exit 2 }
 *
 * The keys, their units, ranges and meaning are what ale_config_print writes (ale-slamd --print-config).
 * Numbers are read as decimals into integers, so that every machine works with the same configuration.
 * An unknown key, a key given twice and a value out of range are errors. Any thread; nothing is kept. */
#ifndef ALE_FIRMWARE_CONFIG_CONFIG_H
#define ALE_FIRMWARE_CONFIG_CONFIG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "command/command.h"
#include "lcm/url.h"
#include "plan/explorer.h"
#include "plan/robot_shape.h"
#include "track/pipeline.h"

enum { ALE_CONFIG_PATH = 160, ALE_PRESET_NAME = 24, ALE_CONFIG_MESSAGE = 440 };

typedef struct {
    ale_pipeline_config_t pipeline; /* extraction with noise, mounting, blind sectors, odometry, limits */
    ale_robot_shape_t robot;        /* width, and how it comes to rest */
    int32_t explore_speed_um_s;     /* most speed of the exploration, by itself */
    int32_t explore_turn_urad_s;
    int32_t explore_clearance_um; /* of its ways, beyond width and margin */
    char type[16];                /* family of the scanner, or "auto" */
    char model[ALE_PRESET_NAME];  /* preset of the noise; empty: by what the scanner says, else by type */
    uint32_t noise_given;         /* keys of [noise] that were set: no preset changes them */
    char port[ALE_CONFIG_PATH];   /* empty: found by serial number */
    char serial[40];              /* empty: any */
    int32_t baud;                 /* 0: detected */
    bool reversed;
    uint16_t first_step; /* 0, 0: what the sensor says */
    uint16_t last_step;
    char lcm_url[ALE_CONFIG_PATH];       /* empty: LCM's own default */
    char lcm_prefix[ALE_LCM_PREFIX + 1]; /* of all channels; empty: none, or what the URL says */
    bool publish_scan;
    bool publish_bot_core;
    int32_t priority; /* 1..97, 0: not real time */
    int32_t cpu;      /* of the estimate task; -1: any */
    bool lock_memory;
    char map[ALE_CONFIG_PATH]; /* loaded at start; empty: none */
    char map_folder[ALE_CONFIG_PATH];
    char name[ALE_NAME_BYTES];        /* the robot's */
    char keys[ALE_CONFIG_PATH];       /* of those who may command it; empty: nobody */
    char own_key[ALE_CONFIG_PATH];    /* the robot's; empty: beside keys, if it is there */
    char drive_key[ALE_CONFIG_PATH];  /* shared with the motor controller; empty: none */
    char drive_port[ALE_CONFIG_PATH]; /* serial line to the motor controller; empty: none */
    int32_t drive_baud;
    int32_t drive_um_s;         /* most that an operator may drive, */
    int32_t drive_urad_s;       /* and turn */
    char keep[ALE_CONFIG_PATH]; /* map and pose, kept while running, taken up at start; empty: not kept */
    int32_t keep_seconds;
    char recorder_folder[ALE_CONFIG_PATH]; /* where flight recordings go; empty: nothing is recorded */
    int32_t recorder_megabytes;
} ale_config_t;

typedef struct {
    char message[ALE_CONFIG_MESSAGE]; /* one line: file:line: section.key: what is wrong */
} ale_config_error_t;

ale_config_t ale_config_default(void);

/* Reads a file over *config: what it does not mention stays. 0, or -1 with *error set and *config
 * unchanged. */
int ale_config_load(const char *path, ale_config_t *config, ale_config_error_t *error);

/* The same from memory; `name` stands for the file in messages. */
int ale_config_parse(const char *text, const char *name, ale_config_t *config, ale_config_error_t *error);

/* What the exploration is told of robot and scanner. */
ale_explorer_config_t ale_config_explorer(const ale_config_t *config);

/* Writes a complete commented file that reads back to the same configuration. */
void ale_config_print(const ale_config_t *config, FILE *out);

#endif
