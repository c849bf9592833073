/* Scans of any geometry, ranges, codes and sectors.
 *
 * proves: lib/base/scan.c
 * with: lib/base/fixed.c lib/base/trig.c
 * options: -eva-auto-loop-unroll 1100 -eva-slevel 20 */
#include "unknown.h"
#include "unknown_scan.h"

void main(void)
{
    static ale_scan_t scan;
    unknown_scan(&scan);
    ale_scan_bearing(&scan, (int32_t)unknown(INT32_MIN, INT32_MAX));
    ale_scan_turn_beams(&scan);
    ale_scan_is_sparse(&scan);
    ale_scan_forgive_missing(&scan);
    const uint16_t beam = (uint16_t)unknown(0, ALE_MAX_BEAMS - 1);
    ale_scan_set_urg(&scan, beam, (int32_t)unknown(INT32_MIN, INT32_MAX / 1000));
    ale_scan_set_range(&scan, beam, (int32_t)unknown(INT32_MIN, INT32_MAX));
    ale_sector_t sectors[ALE_MAX_BLIND_SECTORS];
    Frama_C_make_unknown((char *)sectors, sizeof sectors);
    ale_scan_mask(&scan, sectors, (uint32_t)unknown(0, ALE_MAX_BLIND_SECTORS));

    scan.stamp_beam = (int32_t)unknown(INT32_MIN, INT32_MAX);
    scan.beam_time_ns = (int32_t)unknown(INT32_MIN, INT32_MAX);
    ale_scan_is_sweep(&scan);
    scan.stamp_beam = (int32_t)unknown(-20000, 20000);
    ale_scan_beam_offset_us(&scan, (int32_t)unknown(-20000, 20000));
}
