/* Lines of a scan of which nothing is known but what extract/features.h says of the fields. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_FEATURES_H
#define ALE_PROOFS_EVA_UNKNOWN_FEATURES_H

#include "extract/features.h"
#include "unknown.h"

static inline ale_point_t unknown_place(void)
{
    const int32_t most_um = ALE_MAX_PLACE_UM;
    return (ale_point_t){(int32_t)unknown(-most_um, most_um), (int32_t)unknown(-most_um, most_um)};
}

static inline ale_line_t unknown_line(void)
{
    return (ale_line_t){
        .first = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1),
        .last = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1),
        .points = (uint16_t)unknown(1, ALE_MAX_BEAMS),
        .first_end = (uint8_t)unknown(0, ALE_END_LIMIT),
        .last_end = (uint8_t)unknown(0, ALE_END_LIMIT),
        .alpha_bam = (uint32_t)unknown(0, UINT32_MAX),
        .rho_um = (int32_t)unknown(0, ALE_MAX_PLACE_UM),
        .start = unknown_place(),
        .end = unknown_place(),
        .var_alpha_nrad2 = unknown(0, ALE_MOST_VAR_ALPHA_NRAD2),
        .cov_alpha_rho = unknown(-ALE_MOST_VAR_ALPHA_NRAD2, ALE_MOST_VAR_ALPHA_NRAD2),
        .var_rho_um2 = unknown(0, ALE_MOST_VAR_ALPHA_NRAD2),
        .var_start_um2 = unknown(0, INT64_MAX),
        .var_end_um2 = unknown(0, INT64_MAX),
        .rmse_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM),
    };
}

#endif
