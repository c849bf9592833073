/* What can be set of the extractor. Ranges are checked by ale_extractor_init. */
#ifndef ALE_EXTRACT_CONFIG_H
#define ALE_EXTRACT_CONFIG_H

#include <stdint.h>

#include "base/noise.h"

typedef struct {
    ale_noise_t noise;     /* each deviation 0..100,000 um, ppm; own_ppm_per_m 0..10,000;
                            * shared_beams 1..ALE_MAX_BEAMS;     bearing_nrad 0..100,000,000 */
    uint16_t min_points;   /* fewest beams of a line, 5..ALE_MAX_BEAMS */
    int32_t min_length_um; /* shortest line, from 0 on */
    uint16_t smooth_span;  /* beams of the lowess window, odd, 1..31; 1: not smoothed */
    uint8_t robust_passes; /* upper bound of bisquare passes, 0..8 */
} ale_extract_config_t;

#endif
