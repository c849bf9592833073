#include "config/options.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/version.h"
#include "config/decimal.h"
#include "realtime/clock.h"
#include "store/map_file.h"

static const char help[] =
    "usage: ale-slamd [--config FILE] [--port DEV] [--lcm-url URL] [--map FILE] [--keys FILE]\n"
    "                 [--check-config] [--print-config] [--time-scale X]\n"
    "\n"
    "Reads a Hokuyo URG-04LX and publishes pose, lines, corners and map over LCM.\n"
    "\n"
    "  --config FILE    configuration; --print-config shows every key with its default\n"
    "  --port DEV       serial device of the scanner (sensor.port)\n"
    "  --lcm-url URL    where messages go (lcm.url)\n"
    "  --map FILE       map to start from (map.file)\n"
    "  --keys FILE      keys of those who may command the robot (commands.keys); ale-keys makes them\n"
    "  --check-config   reads the configuration, with keys and map, and says whether it is fine\n"
    "  --print-config   prints the whole configuration, commented, as a file to start from\n"
    "  --time-scale X   the clock runs X times as fast (0.01 to 100), with a simulator's --speed X\n"
    "  --help, --version\n"
    "\n"
    "SIGTERM or SIGINT ends it. Exit status: 0 fine, 1 failed, 2 wrong use or configuration.\n";

typedef struct {
    const char *config;
    const char *port;
    const char *lcm_url;
    const char *map;
    const char *keys;
    const char *time_scale;
    bool check;
    bool print;
} words_t;

enum {
    OPTION_CONFIG,
    OPTION_PORT,
    OPTION_URL,
    OPTION_MAP,
    OPTION_KEYS,
    OPTION_SCALE,
    OPTION_CHECK,
    OPTION_PRINT,
    OPTION_HELP,
    OPTION_VERSION
};

static const struct option long_options[] = {
    {"config", required_argument, NULL, OPTION_CONFIG},
    {"port", required_argument, NULL, OPTION_PORT},
    {"lcm-url", required_argument, NULL, OPTION_URL},
    {"map", required_argument, NULL, OPTION_MAP},
    {"keys", required_argument, NULL, OPTION_KEYS},
    {"time-scale", required_argument, NULL, OPTION_SCALE},
    {"check-config", no_argument, NULL, OPTION_CHECK},
    {"print-config", no_argument, NULL, OPTION_PRINT},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {NULL, 0, NULL, 0},
};

static ale_options_result_t take_word(int option, words_t *words, FILE *out)
{
    switch (option) {
    case OPTION_CONFIG:
        words->config = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_PORT:
        words->port = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_URL:
        words->lcm_url = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_MAP:
        words->map = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_KEYS:
        words->keys = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_SCALE:
        words->time_scale = optarg;
        return ALE_OPTIONS_RUN;
    case OPTION_CHECK:
        words->check = true;
        return ALE_OPTIONS_RUN;
    case OPTION_PRINT:
        words->print = true;
        return ALE_OPTIONS_RUN;
    case OPTION_HELP:
        fputs(help, out);
        return ALE_OPTIONS_DONE;
    case OPTION_VERSION:
    default:
        fputs("ale-slamd " ALE_VERSION "\n", out);
        return ALE_OPTIONS_DONE;
    }
}

/* What getopt_long did not take: in one line, as all programs say it. */
static ale_options_result_t refuse(int option, const char *word)
{
    const int name = (int)strcspn(word, "=");
    if (option == ':') {
        fprintf(stderr, "ale-slamd: %s wants a value (see --help)\n", word);
    } else if (optopt != 0 && word[name] == '=') {
        fprintf(stderr, "ale-slamd: %.*s takes no value (see --help)\n", name, word);
    } else {
        fprintf(stderr, "ale-slamd: unknown option %s (see --help)\n", word);
    }
    return ALE_OPTIONS_REFUSED;
}

static ale_options_result_t read_words(int count, char **arguments, words_t *words, FILE *out)
{
    opterr = 0;
    optind = 0; /* GNU: start afresh */
    const char *word = arguments[1];
    for (int option = 0; (option = getopt_long(count, arguments, "+:", long_options, NULL)) != -1;
         word = arguments[optind]) {
        const ale_options_result_t result =
            option == ':' || option == '?' ? refuse(option, word) : take_word(option, words, out);
        if (result != ALE_OPTIONS_RUN) {
            return result;
        }
    }
    if (optind < count) {
        fprintf(stderr, "ale-slamd: what is \"%s\"? (see --help)\n", arguments[optind]);
        return ALE_OPTIONS_REFUSED;
    }
    return ALE_OPTIONS_RUN;
}

/* Sets a text of the configuration from the command line. */
static bool override(const char *option, const char *word, char *field, size_t size)
{
    if (word && strlen(word) >= size) {
        fprintf(stderr, "ale-slamd: %s: longer than %zu characters\n", option, size - 1);
        return false;
    }
    if (word) {
        snprintf(field, size, "%s", word);
    }
    return true;
}

static bool read_scale(const char *word, int32_t *scale_ppm)
{
    int64_t value = ALE_CLOCK_REAL;
    if (word && (ale_decimal_parse(word, 6, &value) < 0 || value < ALE_CLOCK_REAL / 100 ||
                 value > (int64_t)ALE_CLOCK_REAL * 100)) {
        fprintf(stderr, "ale-slamd: --time-scale %.40s: not a number from 0.01 to 100\n", word);
        return false;
    }
    *scale_ppm = (int32_t)value;
    return true;
}

static bool read_config(const words_t *words, ale_config_t *config)
{
    ale_config_error_t error;
    *config = ale_config_default();
    if (words->config && ale_config_load(words->config, config, &error) < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error.message);
        return false;
    }
    return override("--port", words->port, config->port, sizeof config->port) &&
           override("--lcm-url", words->lcm_url, config->lcm_url, sizeof config->lcm_url) &&
           override("--map", words->map, config->map, sizeof config->map) &&
           override("--keys", words->keys, config->keys, sizeof config->keys);
}

static bool read_keys(const char *path, ale_keys_t *keys)
{
    char error[ALE_KEYS_ERROR];
    *keys = (ale_keys_t){0};
    if (path[0] != '\0' && ale_keys_load(path, keys, error) < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error);
        return false;
    }
    return true;
}

/* The robot's own key: the one that is named, or the one beside its list. */
static bool read_own_key(ale_options_t *options)
{
    const ale_config_t *config = &options->config;
    char path[ALE_CONFIG_PATH + sizeof ALE_OWN_KEY_ENDING];
    char error[ALE_KEYS_ERROR];
    const bool named = config->own_key[0] != '\0';
    snprintf(path, sizeof path, "%s%s", named ? config->own_key : config->keys,
             named ? "" : ALE_OWN_KEY_ENDING);
    options->vouches = named || (config->keys[0] != '\0' && access(path, F_OK) == 0);
    if (options->vouches && ale_robot_key_load(path, &options->own_key, error) < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error);
        return false;
    }
    return true;
}

static bool read_drive_key(ale_options_t *options)
{
    char error[ALE_KEYS_ERROR];
    const char *path = options->config.drive_key;
    options->keyed = path[0] != '\0';
    if (options->keyed && ale_drive_key_load(path, &options->drive_key, error) < 0) {
        fprintf(stderr, "ale-slamd: %s\n", error);
        return false;
    }
    return true;
}

static bool read_all_keys(ale_options_t *options)
{
    return read_keys(options->config.keys, &options->keys) && read_own_key(options) &&
           read_drive_key(options);
}

/* A map to start from is read again by whoever starts: here it is only looked at. */
static bool check_map(const char *path)
{
    char error[ALE_MAP_FILE_ERROR] = "out of memory";
    ale_map_t *map = path[0] != '\0' ? malloc(sizeof *map) : NULL;
    const bool fine = path[0] == '\0' || (map && ale_map_file_load(path, map, error) == 0);
    free(map);
    if (!fine) {
        fprintf(stderr, "ale-slamd: %s\n", error);
    }
    return fine;
}

ale_options_result_t ale_options_read(int count, char **arguments, ale_options_t *options, FILE *out)
{
    words_t words = {0};
    const ale_options_result_t result = read_words(count, arguments, &words, out);
    if (result != ALE_OPTIONS_RUN) {
        return result;
    }
    if (!read_config(&words, &options->config) || !read_scale(words.time_scale, &options->scale_ppm) ||
        !read_all_keys(options)) {
        return ALE_OPTIONS_REFUSED;
    }
    if (words.print) {
        ale_config_print(&options->config, out);
    } else if (words.check) {
        if (!check_map(options->config.map)) {
            return ALE_OPTIONS_REFUSED;
        }
        fprintf(out, "%s: fine\n", words.config ? words.config : "the default configuration");
    }
    return words.print || words.check ? ALE_OPTIONS_DONE : ALE_OPTIONS_RUN;
}
