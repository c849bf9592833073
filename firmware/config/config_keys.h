/* The table of the configuration's keys: where a value lies in ale_config_t, its unit, range and meaning.
 * Reading (config_read.c) and printing (config_print.c) both follow it; a new key is one entry. */
#ifndef ALE_FIRMWARE_CONFIG_CONFIG_KEYS_H
#define ALE_FIRMWARE_CONFIG_CONFIG_KEYS_H

#include <stddef.h>
#include <stdint.h>

typedef enum {
    ALE_KEY_TEXT,    /* char[size] */
    ALE_KEY_BOOL,    /* yes, no */
    ALE_KEY_NUMBER,  /* unsigned or int32 of `size` bytes: the decimal times 10^digits */
    ALE_KEY_ANGLE,   /* uint32 BAM, written in radians; digits 9 */
    ALE_KEY_SECTORS, /* pipeline.blind: from:to in degrees, separated by commas */
    ALE_KEY_ODD,     /* a NUMBER that must be odd */
    ALE_KEY_RATE,    /* a NUMBER that a scanner has as its rate, or 0 */
    ALE_KEY_FAMILY,  /* a TEXT that names a family of scanners */
    ALE_KEY_MODEL,   /* a TEXT that names a preset, or empty */
    ALE_KEY_URL,     /* a TEXT that LCM is joined by, or empty */
    ALE_KEY_PREFIX   /* a TEXT that names of channels may begin with, or empty */
} ale_key_kind_t;

typedef struct {
    const char *section;
    const char *key;
    ale_key_kind_t kind;
    unsigned digits;
    size_t offset; /* in ale_config_t */
    size_t size;   /* bytes of the field */
    int64_t min;   /* in units of the field, inclusive; of an angle: nanoradians */
    int64_t max;
    const char *comment;
} ale_config_key_t;

enum { ALE_CONFIG_MAX_KEYS = 64 };

/* All keys, grouped by section. */
extern const ale_config_key_t ale_config_keys[];
extern const size_t ale_config_key_count;

/* NULL: there is none of that name. */
const ale_config_key_t *ale_config_key(const char *section, const char *name);

/* Bit of a key of [noise] in ale_config_t.noise_given; 0 of all others. */
uint32_t ale_config_noise_bit(const ale_config_key_t *key);

#endif
