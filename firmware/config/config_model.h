/* Which preset of scanners.ini a configuration has for its noise. Any thread; nothing is kept. */
#ifndef ALE_FIRMWARE_CONFIG_CONFIG_MODEL_H
#define ALE_FIRMWARE_CONFIG_CONFIG_MODEL_H

#include "config/config.h"

/* The preset in force where the scanner tells that it is this model (empty: it tells nothing): the configured
 * one, else the one that it is known by, else the usual one of the type. */
void ale_config_preset(const ale_config_t *config, const char *told, char name[ALE_PRESET_NAME]);

/* Noise by that preset, but for what [noise] says. False: no preset is called so. */
bool ale_config_use_preset(ale_config_t *config, const char *name);

#endif
