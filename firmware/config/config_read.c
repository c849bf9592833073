#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <string.h>
#include <sys/stat.h>

#include "base/trig.h"
#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_model.h"
#include "config/decimal.h"
#include "config/degrees.h"
#include "config/presets.h"
#include "scanner/scanner.h"

/* One reading: inih calls the handler without the line's number, so the reader counts lines itself. */
typedef struct {
    FILE *file;
    const char *name;
    ale_config_t config;
    bool seen[ALE_CONFIG_MAX_KEYS];
    int line;
    int error_line; /* 0: none yet; later errors are not of interest */
    char what[240];
    ale_config_error_t *error;
} reading_t;

/* The first error counts; its text was written to reading->what. */
static int fail(reading_t *reading)
{
    if (reading->error_line == 0) {
        reading->error_line = reading->line;
        snprintf(reading->error->message, sizeof reading->error->message, "%.150s:%d: %s", reading->name,
                 reading->line, reading->what);
    }
    return -1;
}

#define FAIL(reading, ...) (snprintf((reading)->what, sizeof(reading)->what, __VA_ARGS__), fail(reading))

static int fail_range(reading_t *reading, const ale_config_key_t *key, const char *text)
{
    char low[ALE_DECIMAL_TEXT];
    char high[ALE_DECIMAL_TEXT];
    ale_decimal_print(key->min, key->digits, low);
    ale_decimal_print(key->max, key->digits, high);
    return FAIL(reading, "%s.%s: %.40s is not a number from %s to %s%s", key->section, key->key, text, low,
                high, key->kind == ALE_KEY_ODD ? ", odd" : "");
}

static void store_number(void *field, size_t size, int64_t value)
{
    const uint8_t byte = (uint8_t)value;
    const uint16_t half = (uint16_t)value;
    const int32_t word = (int32_t)value;
    if (size == sizeof byte) {
        memcpy(field, &byte, size);
    } else if (size == sizeof half) {
        memcpy(field, &half, size);
    } else {
        memcpy(field, &word, size);
    }
}

static int read_number(reading_t *reading, const ale_config_key_t *key, void *field, const char *text)
{
    int64_t value = 0;
    if (ale_decimal_parse(text, key->digits, &value) < 0 || value < key->min || value > key->max ||
        (key->kind == ALE_KEY_ODD && value % 2 == 0)) {
        return fail_range(reading, key, text);
    }
    if (key->kind == ALE_KEY_ANGLE) {
        value = ale_nrad_to_bam(value);
    }
    store_number(field, key->size, value);
    return 0;
}

static int read_bool(reading_t *reading, const ale_config_key_t *key, bool *field, const char *text)
{
    static const char *const words[] = {"no", "yes", "false", "true", "off", "on", "0", "1"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        if (strcmp(text, words[k]) == 0) {
            *field = k % 2 == 1;
            return 0;
        }
    }
    return FAIL(reading, "%s.%s: %.40s is neither yes nor no", key->section, key->key, text);
}

static int read_text(reading_t *reading, const ale_config_key_t *key, char *field, const char *text)
{
    if (strlen(text) >= key->size) {
        return FAIL(reading, "%s.%s: longer than %zu characters", key->section, key->key, key->size - 1);
    }
    snprintf(field, key->size, "%s", text);
    return 0;
}

static int read_rate(reading_t *reading, const ale_config_key_t *key, int32_t *field, const char *text)
{
    if (read_number(reading, key, field, text) < 0) {
        return -1;
    }
    return *field == 0 || ale_scanner_has_baud(*field)
               ? 0
               : FAIL(
                     reading,
                     "%s.%s: %.40s is no rate that a scanner has: 9600, 19200, 38400, 57600, 115200, 230400, "
                     "250000, 256000, 460800, 500000, 750000 or 1000000; 0: found by trying",
                     key->section, key->key, text);
}

static int read_family(reading_t *reading, const ale_config_key_t *key, char *field, const char *text)
{
    char names[ALE_SCANNER_NAMES];
    ale_scanner_families(names);
    return ale_scanner_has_family(text)
               ? read_text(reading, key, field, text)
               : FAIL(reading, "%s.%s: %.40s is none of %s", key->section, key->key, text, names);
}

static int read_model(reading_t *reading, const ale_config_key_t *key, char *field, const char *text)
{
    ale_noise_t noise;
    if (text[0] != '\0' && !ale_preset_noise(text, &noise)) {
        char names[ALE_PRESET_NAMES];
        ale_preset_names(names);
        return FAIL(reading, "%s.%s: %.40s is none of %s", key->section, key->key, text, names);
    }
    return read_text(reading, key, field, text);
}

static int read_url(reading_t *reading, const ale_config_key_t *key, char *field, const char *text)
{
    char error[ALE_LCM_URL_ERROR];
    if (text[0] != '\0' && !ale_lcm_url(text, error)) {
        return FAIL(reading, "%s.%s: %.150s", key->section, key->key, error);
    }
    return read_text(reading, key, field, text);
}

static int read_prefix(reading_t *reading, const ale_config_key_t *key, char *field, const char *text)
{
    return ale_lcm_is_prefix(text) ? read_text(reading, key, field, text)
                                   : FAIL(reading, "%s.%s: at most %d letters, digits and . _ - /",
                                          key->section, key->key, ALE_LCM_PREFIX);
}

static int parse_sector(char *text, ale_sector_t *sector)
{
    char *rest = NULL;
    const char *from = strtok_r(text, ": \t", &rest);
    const char *to = strtok_r(NULL, ": \t", &rest);
    if (!from || !to || strtok_r(NULL, ": \t", &rest)) {
        return -1;
    }
    return ale_degrees_parse(from, &sector->from_bam) < 0 ? -1 : ale_degrees_parse(to, &sector->to_bam);
}

static int read_sectors(reading_t *reading, const ale_config_key_t *key, const char *text)
{
    ale_pipeline_config_t *pipeline = &reading->config.pipeline;
    char copy[ALE_CONFIG_MESSAGE];
    snprintf(copy, sizeof copy, "%s", text);
    pipeline->blind_count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(copy, ",", &rest); word; word = strtok_r(NULL, ",", &rest)) {
        if (pipeline->blind_count == ALE_MAX_BLIND_SECTORS) {
            return FAIL(reading, "%s.%s: more than %d sectors", key->section, key->key,
                        ALE_MAX_BLIND_SECTORS);
        }
        if (parse_sector(word, &pipeline->blind[pipeline->blind_count]) < 0) {
            return FAIL(reading, "%s.%s: a sector is from:to in degrees, -360 to 360", key->section,
                        key->key);
        }
        pipeline->blind_count++;
    }
    return 0;
}

static int read_value(reading_t *reading, const ale_config_key_t *key, const char *text)
{
    char *field = (char *)&reading->config + key->offset;
    switch (key->kind) {
    case ALE_KEY_TEXT:
        return read_text(reading, key, field, text);
    case ALE_KEY_BOOL:
        return read_bool(reading, key, (bool *)field, text);
    case ALE_KEY_SECTORS:
        return read_sectors(reading, key, text);
    case ALE_KEY_RATE:
        return read_rate(reading, key, (int32_t *)(void *)field, text);
    case ALE_KEY_FAMILY:
        return read_family(reading, key, field, text);
    case ALE_KEY_MODEL:
        return read_model(reading, key, field, text);
    case ALE_KEY_URL:
        return read_url(reading, key, field, text);
    case ALE_KEY_PREFIX:
        return read_prefix(reading, key, field, text);
    case ALE_KEY_NUMBER:
    case ALE_KEY_ODD:
    case ALE_KEY_ANGLE:
        break;
    }
    return read_number(reading, key, field, text);
}

static bool *seen(reading_t *reading, const ale_config_key_t *key)
{
    return &reading->seen[key - ale_config_keys];
}

/* inih's handler: 1 fine, 0 error. */
static int take_entry(void *user, const char *section, const char *name, const char *value)
{
    reading_t *reading = user;
    const ale_config_key_t *key = ale_config_key(section, name);
    if (!key) {
        return FAIL(reading, "%.60s.%.60s: no such key", section, name) == 0;
    }
    if (*seen(reading, key)) {
        return FAIL(reading, "%s.%s: given twice", section, name) == 0;
    }
    *seen(reading, key) = true;
    reading->config.noise_given |= ale_config_noise_bit(key);
    return read_value(reading, key, value) == 0;
}

/* A character of text, or of the space within it. */
static bool is_of_text(int c)
{
    return c != '\0' && (!iscntrl(c) || isspace(c));
}

/* A line with its end, as fgets does, but a NUL is no end. False at the end of the file, and where there is
 * what is no text: a file that was being written when power went may hold nothing but NULs. */
static bool read_line(reading_t *reading, char *buffer, size_t size)
{
    size_t count = 0;
    int c = '\0';
    while (count + 1 < size && c != '\n' && (c = fgetc(reading->file)) != EOF) {
        if (!is_of_text(c)) {
            reading->line++;
            FAIL(reading, "holds control characters: this is no text");
            return false;
        }
        buffer[count++] = (char)c;
    }
    buffer[count] = '\0';
    reading->line += count > 0;
    return count > 0;
}

/* inih's line source. A line that does not fit its buffer would be read as two: refused. An indented line
 * would be taken for more of the value above it: the indent goes. */
static char *next_line(char *buffer, int size, void *stream)
{
    reading_t *reading = stream;
    if (!read_line(reading, buffer, (size_t)size)) {
        return NULL;
    }
    if (strlen(buffer) + 1 == (size_t)size && buffer[size - 2] != '\n') {
        FAIL(reading, "longer than %d characters", size - 2);
        for (int c = fgetc(reading->file); c != EOF && c != '\n';) {
            c = fgetc(reading->file);
        }
    }
    const size_t indent = strspn(buffer, " \t");
    memmove(buffer, buffer + indent, strlen(buffer + indent) + 1);
    return buffer;
}

static int check_steps(reading_t *reading)
{
    if (reading->config.first_step > reading->config.last_step) {
        return FAIL(reading, "sensor.last_step: %d is below sensor.first_step %d", reading->config.last_step,
                    reading->config.first_step);
    }
    return 0;
}

/* Who says which scanner it is says how rough it is. */
static void take_preset(reading_t *reading)
{
    if (*seen(reading, ale_config_key("sensor", "model")) ||
        *seen(reading, ale_config_key("sensor", "type"))) {
        char name[ALE_PRESET_NAME];
        ale_config_preset(&reading->config, "", name);
        ale_config_use_preset(&reading->config, name);
    }
}

static int read_stream(reading_t *reading, ale_config_t *config)
{
    reading->config = *config;
    const int bad_line = ini_parse_stream(next_line, reading, take_entry, reading);
    if (bad_line > 0 && (reading->error_line == 0 || bad_line < reading->error_line)) {
        reading->error_line = 0;
        reading->line = bad_line;
        FAIL(reading, "neither [section], key = value, nor comment");
    }
    if (reading->error_line == 0) {
        check_steps(reading);
    }
    if (reading->error_line != 0) {
        return -1;
    }
    take_preset(reading);
    *config = reading->config;
    return 0;
}

int ale_config_load(const char *path, ale_config_t *config, ale_config_error_t *error)
{
    reading_t reading = {.name = path, .error = error, .file = fopen(path, "r")};
    if (!reading.file) {
        snprintf(error->message, sizeof error->message, "%.150s: %s", path, strerror(errno));
        return -1;
    }
    struct stat status;
    const bool folder = fstat(fileno(reading.file), &status) == 0 && S_ISDIR(status.st_mode);
    int result = folder ? -1 : read_stream(&reading, config);
    if (folder || (result == 0 && ferror(reading.file))) {
        snprintf(error->message, sizeof error->message, "%.150s: %s", path,
                 folder ? "is a directory" : "cannot be read");
        result = -1;
    }
    fclose(reading.file);
    return result;
}

int ale_config_parse(const char *text, const char *name, ale_config_t *config, ale_config_error_t *error)
{
    if (*text == '\0') {
        return 0;
    }
    reading_t reading = {.name = name, .error = error, .file = fmemopen((void *)text, strlen(text), "r")};
    if (!reading.file) {
        snprintf(error->message, sizeof error->message, "%.150s: %s", name, strerror(errno));
        return -1;
    }
    const int result = read_stream(&reading, config);
    fclose(reading.file);
    return result;
}
