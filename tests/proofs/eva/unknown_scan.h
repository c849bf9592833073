/* A scan of which nothing is known but what base/scan.h says of its fields. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_SCAN_H
#define ALE_PROOFS_EVA_UNKNOWN_SCAN_H

#include "base/scan.h"
#include "unknown.h"

static inline void unknown_scan(ale_scan_t *scan)
{
    Frama_C_make_unknown((char *)scan, sizeof *scan);
    scan->stamp_us = unknown(-ALE_MAX_STAMP_US, ALE_MAX_STAMP_US);
    scan->range_min_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM);
    scan->range_max_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM);
    scan->beams = (uint16_t)unknown(0, ALE_MAX_BEAMS);
    scan->own_bearings = unknown(0, 1);
}

#endif
