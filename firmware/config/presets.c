#include "config/presets.h"

#include <ini.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "config/config_keys.h"
#include "config/decimal.h"

/* Made of scanners.ini. */
extern const char ale_scanners_ini[];

/* What is looked for in the presets, and what was found. */
typedef struct {
    const char *name; /* of the preset whose noise is wanted, */
    bool found;
    ale_noise_t noise;
    const char *model; /* that a scanner tells, */
    size_t fit;        /* how much of it the best identity is */
    char best[ALE_PRESET_NAME];
    char last[ALE_PRESET_NAME]; /* section that was read last */
    char *names;
} search_t;

/* Keys are those of [noise]; others are the geometry's. */
static void take_noise(search_t *search, const char *name, const char *value)
{
    const ale_config_key_t *key = ale_config_key("noise", name);
    int64_t number = 0;
    if (key && ale_decimal_parse(value, key->digits, &number) == 0) {
        const int32_t field = (int32_t)number;
        memcpy((char *)&search->noise + key->offset - offsetof(ale_config_t, pipeline.extract.noise), &field,
               sizeof field);
    }
}

static void take_identity(search_t *search, const char *section, const char *identity)
{
    const size_t length = strlen(identity);
    if (length > search->fit && strncmp(identity, search->model, length) == 0) {
        search->fit = length;
        snprintf(search->best, sizeof search->best, "%s", section);
    }
}

static void take_name(search_t *search, const char *section)
{
    if (search->names && strcmp(search->last, section) != 0) {
        const size_t used = strlen(search->names);
        snprintf(search->names + used, ALE_PRESET_NAMES - used, "%s%s", used > 0 ? ", " : "", section);
    }
    snprintf(search->last, sizeof search->last, "%s", section);
}

/* inih's handler. */
static int take_entry(void *user, const char *section, const char *key, const char *value)
{
    search_t *search = user;
    take_name(search, section);
    if (search->name && strcmp(search->name, section) == 0) {
        search->found = true;
        take_noise(search, key, value);
    }
    if (search->model && strcmp(key, "identity") == 0) {
        take_identity(search, section, value);
    }
    return 1;
}

bool ale_preset_noise(const char *name, ale_noise_t *noise)
{
    search_t search = {.name = name, .noise = ale_noise_default()};
    ini_parse_string(ale_scanners_ini, take_entry, &search);
    if (search.found) {
        *noise = search.noise;
    }
    return search.found;
}

void ale_preset_names(char names[ALE_PRESET_NAMES])
{
    search_t search = {.names = names};
    names[0] = '\0';
    ini_parse_string(ale_scanners_ini, take_entry, &search);
}

bool ale_preset_identify(const char *model, char name[ALE_PRESET_NAME])
{
    search_t search = {.model = model};
    ini_parse_string(ale_scanners_ini, take_entry, &search);
    if (search.fit > 0) {
        memcpy(name, search.best, ALE_PRESET_NAME);
    }
    return search.fit > 0;
}
