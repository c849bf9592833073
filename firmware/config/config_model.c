#include "config/config_model.h"

#include <stdio.h>
#include <string.h>

#include "config/config_keys.h"
#include "config/presets.h"

/* Of scanners that do not say which one they are. */
static const char *usual_model(const char *type)
{
    if (strcmp(type, "ldrobot") == 0) {
        return "ld06";
    }
    return strcmp(type, "rplidar") == 0 ? "rplidar-a1" : "urg-04lx";
}

void ale_config_preset(const ale_config_t *config, const char *told, char name[ALE_PRESET_NAME])
{
    const bool configured = config->model[0] != '\0';
    if (configured || !ale_preset_identify(told, name)) {
        snprintf(name, ALE_PRESET_NAME, "%s", configured ? config->model : usual_model(config->type));
    }
}

bool ale_config_use_preset(ale_config_t *config, const char *name)
{
    ale_config_t preset;
    if (!ale_preset_noise(name, &preset.pipeline.extract.noise)) {
        return false;
    }
    for (size_t k = 0; k < ale_config_key_count; k++) {
        const ale_config_key_t *key = &ale_config_keys[k];
        const uint32_t bit = ale_config_noise_bit(key);
        if (bit != 0 && (config->noise_given & bit) == 0) {
            memcpy((char *)config + key->offset, (const char *)&preset + key->offset, key->size);
        }
    }
    return true;
}
