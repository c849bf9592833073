/* Turns of any points, in any order, of any times: twice, for the memory is used again.
 *
 * proves: lib/base/turn.c
 * with: lib/base/scan.c lib/base/fixed.c lib/base/trig.c
 * options: -eva-precision 0 */
#include "unknown.h"

#include "base/turn.h"

static ale_turn_t turn;
static ale_scan_t scan;

static void add_points(void)
{
    while (unknown(0, 1)) {
        ale_turn_add(&turn, (uint32_t)unknown(0, UINT32_MAX), (int32_t)unknown(INT32_MIN, INT32_MAX),
                     (ale_beam_flag_t)unknown(0, ALE_BEAM_TOO_NEAR));
    }
}

void main(void)
{
    //@ widen_hints global:"all", 1080, 1081, 4095, 4096;
    while (unknown(0, 1)) {
        ale_turn_begin(&turn);
        add_points();
        turn.first_us = unknown(-ALE_MAX_STAMP_US / 2, ALE_MAX_STAMP_US / 2);
        turn.last_us = turn.first_us + unknown(-ALE_TURN_MOST_US, ALE_TURN_MOST_US);
        scan.range_min_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM);
        scan.range_max_um = (int32_t)unknown(0, ALE_MAX_RANGE_UM);
        ale_turn_status_text(ale_turn_to_scan(&turn, &scan));
    }
    ale_turn_status_text((ale_turn_status_t)unknown(-4, 1));
}
