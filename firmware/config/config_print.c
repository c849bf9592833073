#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_model.h"
#include "config/decimal.h"
#include "config/degrees.h"

static void print_comment(const char *comment, FILE *out)
{
    while (*comment) {
        const size_t length = strcspn(comment, "\n");
        fprintf(out, "# %.*s\n", (int)length, comment);
        comment += length + (comment[length] == '\n');
    }
}

static int64_t load_number(const void *field, size_t size)
{
    uint8_t byte = 0;
    uint16_t half = 0;
    int32_t word = 0;
    if (size == sizeof byte) {
        memcpy(&byte, field, size);
        return byte;
    }
    if (size == sizeof half) {
        memcpy(&half, field, size);
        return half;
    }
    memcpy(&word, field, size);
    return word;
}

/* The shortest decimal in radians that reads back to the same angle. */
static void print_angle(const ale_config_key_t *key, int32_t angle_bam, char text[ALE_DECIMAL_TEXT])
{
    const int64_t nrad = ale_bam_to_nrad(angle_bam);
    for (unsigned kept = 0; kept <= key->digits; kept++) {
        const int64_t rounded = ale_clamp64(ale_decimal_round(nrad, key->digits, kept), key->min, key->max);
        ale_decimal_print(rounded, key->digits, text);
        if (ale_nrad_to_bam(rounded) == angle_bam) {
            return;
        }
    }
}

static void print_sectors(const ale_pipeline_config_t *pipeline, FILE *out)
{
    char from[ALE_DECIMAL_TEXT];
    char to[ALE_DECIMAL_TEXT];
    for (uint32_t k = 0; k < pipeline->blind_count; k++) {
        ale_degrees_print(pipeline->blind[k].from_bam, from);
        ale_degrees_print(pipeline->blind[k].to_bam, to);
        fprintf(out, "%s%s:%s", k ? ", " : "", from, to);
    }
}

/* Kinds of text are printed as they are. */
static void print_value(const ale_config_t *config, const ale_config_key_t *key, FILE *out)
{
    const char *field = (const char *)config + key->offset;
    char text[ALE_DECIMAL_TEXT];
    switch (key->kind) {
    case ALE_KEY_BOOL:
        fputs(*(const bool *)field ? "yes" : "no", out);
        break;
    case ALE_KEY_SECTORS:
        print_sectors(&config->pipeline, out);
        break;
    case ALE_KEY_ANGLE:
        print_angle(key, (int32_t)load_number(field, key->size), text);
        fputs(text, out);
        break;
    case ALE_KEY_NUMBER:
    case ALE_KEY_ODD:
    case ALE_KEY_RATE:
        ale_decimal_print(load_number(field, key->size), key->digits, text);
        fputs(text, out);
        break;
    default:
        fputs(field, out);
        break;
    }
}

/* What the preset says is a remark: it follows another model. */
static bool is_of_preset(const ale_config_t *config, const ale_config_t *preset, const ale_config_key_t *key)
{
    const uint32_t bit = ale_config_noise_bit(key);
    return bit != 0 && (config->noise_given & bit) == 0 &&
           memcmp((const char *)config + key->offset, (const char *)preset + key->offset, key->size) == 0;
}

void ale_config_print(const ale_config_t *config, FILE *out)
{
    const char *section = "";
    ale_config_t preset = {0};
    char name[ALE_PRESET_NAME];
    ale_config_preset(config, "", name);
    ale_config_use_preset(&preset, name);
    fputs("# ALE-SLAM configuration.  Lines that are left out mean the default.\n", out);
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const ale_config_key_t *key = &ale_config_keys[k];
        if (strcmp(section, key->section) != 0) {
            section = key->section;
            fprintf(out, "\n[%s]\n", section);
        }
        print_comment(key->comment, out);
        fprintf(out, "%s%s = ", is_of_preset(config, &preset, key) ? "# " : "", key->key);
        print_value(config, key, out);
        fputc('\n', out);
    }
}
