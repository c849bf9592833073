#include "base/scan.h"

#include "base/fixed.h"
#include "base/trig.h"

enum { URG_FIRST_RANGE_MM = 20, URG_NOT_A_STEP = 19 };

static const int64_t Q8 = 256; /* multiplied by: a negative number is not to be shifted */

int32_t ale_scan_turn_beams(const ale_scan_t *scan)
{
    const int64_t step_bam = ale_abs64(scan->step_bam);
    const int64_t last = scan->beams - 1;
    if (last * step_bam <= ALE_BAM_HALF_TURN || last * step_bam > UINT32_MAX + step_bam) {
        return 0;
    }
    const int64_t turn_bam = ale_bam_diff(scan->first_bearing_bam, ale_scan_bearing(scan, (int32_t)last));
    const int64_t ahead_bam = scan->step_bam < 0 ? -turn_bam : turn_bam;
    const int64_t gap =
        ale_max64(ale_round_div(ahead_bam, step_bam), 1); /* or the ends meet, give or take a step */
    return ahead_bam < -step_bam || gap > ALE_MAX_GAP_BEAMS ? 0 : (int32_t)(last + gap);
}

int64_t ale_scan_own_place_q8(const ale_scan_t *scan, int32_t beam)
{
    const int64_t step_bam = ale_abs64(scan->step_bam);
    if (beam < 0 || beam >= scan->beams || step_bam == 0) {
        return beam * Q8;
    }
    const uint32_t ahead_bam = scan->bearing_bam[beam] - scan->first_bearing_bam;
    const int64_t here_q8 = ale_round_div((scan->step_bam < 0 ? 0U - ahead_bam : ahead_bam) * Q8, step_bam);
    return ale_min64(here_q8, scan->beams * Q8);
}

int32_t ale_scan_beam_offset_us(const ale_scan_t *scan, int32_t beam)
{
    if (scan->own_bearings) {
        const int64_t from_stamp_q8 = ale_scan_own_place_q8(scan, beam) - scan->stamp_beam * Q8;
        return (int32_t)ale_round_div(from_stamp_q8 * scan->beam_time_ns, 256000);
    }
    return (int32_t)ale_round_div((int64_t)(beam - scan->stamp_beam) * scan->beam_time_ns, 1000);
}

bool ale_scan_is_sweep(const ale_scan_t *scan)
{
    const int64_t most_beams = ale_abs64(scan->stamp_beam) + scan->beams;
    return most_beams * ale_abs64(scan->beam_time_ns) <= 1000LL * ALE_MAX_SWEEP_US;
}

void ale_scan_mask(ale_scan_t *scan, const ale_sector_t *sectors, uint32_t count)
{
    for (uint32_t s = 0; s < count; s++) {
        const uint32_t width_bam = sectors[s].to_bam - sectors[s].from_bam;
        for (int32_t k = 0; k < scan->beams; k++) {
            if (ale_scan_bearing(scan, k) - sectors[s].from_bam <= width_bam) {
                scan->flag[k] = ALE_BEAM_BLIND;
                scan->range_um[k] = 0;
            }
        }
    }
}

void ale_scan_forgive_missing(ale_scan_t *scan)
{
    int32_t last = -ALE_MAX_GAP_BEAMS - 1; /* none: beams before the first echo lie between no two */
    for (int32_t k = 0; k < scan->beams; k++) {
        if (scan->flag[k] != ALE_BEAM_VALID) {
            continue;
        }
        for (int32_t i = last < 0 ? 0 : last + 1; k - last <= ALE_MAX_GAP_BEAMS && i < k; i++) {
            scan->flag[i] = scan->flag[i] == ALE_BEAM_NO_RETURN ? ALE_BEAM_UNKNOWN : scan->flag[i];
        }
        last = k;
    }
}

static ale_beam_flag_t urg_code_meaning(int32_t code)
{
    switch (code) {
    case 0:
    case 6:
        return ALE_BEAM_NO_RETURN;
    case URG_NOT_A_STEP:
        return ALE_BEAM_BLIND;
    default:
        return ALE_BEAM_UNKNOWN;
    }
}

void ale_scan_set_urg(ale_scan_t *scan, uint16_t beam, int32_t value_mm)
{
    if (value_mm >= URG_FIRST_RANGE_MM) {
        ale_scan_set_range(scan, beam, value_mm * 1000);
        return;
    }
    scan->code[beam] = (uint8_t)(value_mm < 0 ? 0 : value_mm);
    scan->range_um[beam] = 0;
    scan->flag[beam] = (uint8_t)urg_code_meaning(value_mm < 0 ? 0 : value_mm);
}

void ale_scan_set_range(ale_scan_t *scan, uint16_t beam, int32_t range_um)
{
    const bool nothing = range_um <= 0 || range_um >= scan->range_max_um;
    const bool near = !nothing && range_um < scan->range_min_um;
    scan->code[beam] = 0;
    scan->range_um[beam] = nothing || near ? 0 : range_um;
    scan->flag[beam] = nothing ? ALE_BEAM_NO_RETURN : (near ? ALE_BEAM_TOO_NEAR : ALE_BEAM_VALID);
}
