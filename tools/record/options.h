/* Command line of ale-record. */
#ifndef RECORD_OPTIONS_H
#define RECORD_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    const char *port;   /* NULL: the scanner is looked for */
    const char *serial; /* NULL: any */
    const char *out;
    const char *lcm_url; /* NULL: the environment's, else LCM's default */
    bool no_lcm;
    int32_t baud;           /* 0: detect */
    int64_t seconds;        /* 0: until a signal */
    int32_t time_scale_ppm; /* clock against real time */
} record_options_t;

enum { RECORD_GO_ON = -1 };

/* Fills *options and returns RECORD_GO_ON, or the exit code when all is said already. */
int record_parse_options(int argc, char **argv, record_options_t *options);

#endif
