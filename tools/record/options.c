#include "record/options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "clock.h"
#include "decimal.h"

#ifndef ALE_VERSION
#define ALE_VERSION "0.1"
#endif

enum { WRONG_USE = 2, MOST_SECONDS = 31536000, MOST_BAUD = 4000000, SCALE_DIGITS = 6 };

static const char help[] =
    "usage: ale-record --port DEV --out FILE [--seconds N] [--lcm-url URL | --no-lcm]\n"
    "                  [--serial S] [--baud N] [--time-scale X]\n"
    "\n"
    "Records a Hokuyo URG-04LX: every byte on its serial line, both ways, and the wheel odometry from LCM,\n"
    "as a .scip recording that ale-replay and ale-sim play.\n"
    "\n"
    "  --port DEV      serial device of the scanner; without it, --serial says which one to look for\n"
    "  --out FILE      the recording\n"
    "  --seconds N     ends after N seconds; without it, Ctrl-C or SIGTERM ends it\n"
    "  --lcm-url URL   where ALE_ODOMETRY comes from\n"
    "  --no-lcm        records the scanner only\n"
    "  --serial S      only the scanner with this serial number\n"
    "  --baud N        baud rate of a real RS-232 line; without it the rate is detected\n"
    "  --time-scale X  the clock runs X times as fast (0.01 to 100), with a simulator's --speed X\n"
    "  --help, --version\n"
    "\n"
    "Exit status: 0 fine, 1 no scan came or the recording could not be written, 2 wrong use.\n";

static int wrong_use(const char *what, const char *value)
{
    fprintf(stderr, "ale-record: %s%s%s (--help tells the options)\n", what, value[0] != '\0' ? ": " : "",
            value);
    return WRONG_USE;
}

static bool whole_number(const char *text, int64_t most, int64_t *out)
{
    char *end = NULL;
    const long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || value <= 0 || value > most) {
        return false;
    }
    *out = value;
    return true;
}

static bool time_scale(const char *text, int32_t *out)
{
    int64_t ppm = 0;
    if (ale_decimal_parse(text, SCALE_DIGITS, &ppm) < 0 || ppm < 10000 || ppm > 100000000) {
        return false;
    }
    *out = (int32_t)ppm;
    return true;
}

static const struct option known[] = {
    {"port", required_argument, NULL, 'p'},
    {"out", required_argument, NULL, 'o'},
    {"seconds", required_argument, NULL, 's'},
    {"lcm-url", required_argument, NULL, 'l'},
    {"no-lcm", no_argument, NULL, 'n'},
    {"serial", required_argument, NULL, 'i'},
    {"baud", required_argument, NULL, 'b'},
    {"time-scale", required_argument, NULL, 't'},
    {"help", no_argument, NULL, 'h'},
    {"version", no_argument, NULL, 'v'},
    {NULL, 0, NULL, 0},
};

/* One option; RECORD_GO_ON or the exit code. */
static int take(int choice, record_options_t *options)
{
    int64_t number = 0;
    switch (choice) {
    case 'p':
        options->port = optarg;
        return RECORD_GO_ON;
    case 'o':
        options->out = optarg;
        return RECORD_GO_ON;
    case 'l':
        options->lcm_url = optarg;
        return RECORD_GO_ON;
    case 'n':
        options->no_lcm = true;
        return RECORD_GO_ON;
    case 'i':
        options->serial = optarg;
        return RECORD_GO_ON;
    case 's':
        return whole_number(optarg, MOST_SECONDS, &options->seconds)
                   ? RECORD_GO_ON
                   : wrong_use("--seconds wants a whole number of seconds", optarg);
    case 'b':
        if (!whole_number(optarg, MOST_BAUD, &number)) {
            return wrong_use("--baud wants a baud rate", optarg);
        }
        options->baud = (int32_t)number;
        return RECORD_GO_ON;
    case 't':
        return time_scale(optarg, &options->time_scale_ppm)
                   ? RECORD_GO_ON
                   : wrong_use("--time-scale wants a number from 0.01 to 100", optarg);
    case 'h':
        fputs(help, stdout);
        return EXIT_SUCCESS;
    case 'v':
        puts("ale-record " ALE_VERSION);
        return EXIT_SUCCESS;
    default:
        return WRONG_USE;
    }
}

int record_parse_options(int argc, char **argv, record_options_t *options)
{
    *options = (record_options_t){.time_scale_ppm = ALE_CLOCK_REAL};
    for (int choice; (choice = getopt_long(argc, argv, "", known, NULL)) != -1;) {
        const int result = take(choice, options);
        if (result != RECORD_GO_ON) {
            return result;
        }
    }
    if (optind < argc) {
        return wrong_use("not an option", argv[optind]);
    }
    if (options->out == NULL) {
        return wrong_use("--out FILE is missing", "");
    }
    if (options->port == NULL && options->serial == NULL) {
        return wrong_use("--port DEV (or --serial S) is missing", "");
    }
    if (options->no_lcm && options->lcm_url != NULL) {
        return wrong_use("--lcm-url and --no-lcm exclude each other", "");
    }
    return RECORD_GO_ON;
}
