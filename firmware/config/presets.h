/* Presets of scanners: scanners.ini, which is compiled in. Any thread; nothing is kept. */
#ifndef ALE_FIRMWARE_CONFIG_PRESETS_H
#define ALE_FIRMWARE_CONFIG_PRESETS_H

#include <stdbool.h>

#include "config/config.h"

enum { ALE_PRESET_NAMES = 160 };

/* How rough the ranges of the scanner of that name are. False: no preset is called so, and *noise is as it
 * was. */
bool ale_preset_noise(const char *name, ale_noise_t *noise);

/* "urg-04lx, utm-30lx, ..." */
void ale_preset_names(char names[ALE_PRESET_NAMES]);

/* The preset of a scanner by the model that it tells: the one whose identity is the longest that the model
 * begins with. False: none. */
bool ale_preset_identify(const char *model, char name[ALE_PRESET_NAME]);

#endif
