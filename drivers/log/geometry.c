#include "log/geometry.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    URG_AHEAD_STEP = 384,
    URG_BEAM_TIME_NS = 97656, /* 100 ms a turn, 1024 steps */
    URG_RANGE_MIN_UM = 20000,
    URG_RANGE_MAX_UM = 5600000, /* as the device states it (PP: DMAX) */
    OLD_SICK_NOTHING_UM = 31900000,
    SICK_CODES_FROM_UM =
        32759000, /* the nine highest values of 15 bits are codes of the SICK's 32 m setting */
    SICK_CODES_TO_UM = 32767000,
    DEGREES_A_TURN = 360,
    PRINTED_STEP_BAM = 684 /* 10^-6 rad, the coarsest that a resolution is printed with */
};

void ale_geometry_urg(ale_scan_t *scan, int32_t first_step, uint16_t beams)
{
    scan->beams = beams;
    scan->step_bam = ALE_URG_STEP_BAM;
    scan->first_bearing_bam = (uint32_t)(first_step - URG_AHEAD_STEP) * ALE_URG_STEP_BAM;
    scan->beam_time_ns = URG_BEAM_TIME_NS;
    scan->range_min_um = URG_RANGE_MIN_UM;
    scan->range_max_um = URG_RANGE_MAX_UM;
}

/* Counts that name a scanner's setting: field of view and beams a turn. */
static const struct {
    uint16_t beams;
    uint16_t beams_a_turn;
    uint16_t first_degrees; /* to the right of straight ahead */
} KNOWN[] = {{180, 360, 90},  {181, 360, 90},  {360, 720, 90},    {361, 720, 90},
             {400, 1440, 50}, {401, 1440, 50}, {540, 720, 135},   {541, 720, 135},
             {720, 1440, 90}, {721, 1440, 90}, {1080, 1440, 135}, {1081, 1440, 135}};

static int32_t whole_turn_over(int64_t parts)
{
    return (int32_t)ale_round_div((int64_t)1 << 32, parts);
}

void ale_geometry_by_count(ale_scan_t *scan, uint16_t beams)
{
    scan->beams = beams;
    for (uint32_t i = 0; i < sizeof KNOWN / sizeof KNOWN[0]; i++) {
        if (KNOWN[i].beams == beams) {
            scan->step_bam = whole_turn_over(KNOWN[i].beams_a_turn);
            scan->first_bearing_bam =
                0U - (uint32_t)ale_round_div((int64_t)KNOWN[i].first_degrees << 32, DEGREES_A_TURN);
            return;
        }
    }
    scan->step_bam = beams > 1 ? whole_turn_over(2 * ((int64_t)beams - 1)) : 0;
    scan->first_bearing_bam = 0U - ALE_BAM_QUARTER_TURN;
}

int32_t ale_geometry_whole_step(int32_t step_bam)
{
    if (ale_abs64(step_bam) <= PRINTED_STEP_BAM) {
        return step_bam;
    }
    const int64_t turn = (int64_t)1 << 32;
    const int64_t whole = ale_round_div(turn, ale_round_div(turn, ale_abs64(step_bam)));
    const int64_t exact = step_bam < 0 ? -whole : whole;
    return ale_abs64(exact - step_bam) <= PRINTED_STEP_BAM ? (int32_t)exact : step_bam;
}

void ale_geometry_set_range(ale_scan_t *scan, uint16_t beam, int32_t range_um)
{
    const bool code = range_um >= SICK_CODES_FROM_UM && range_um <= SICK_CODES_TO_UM;
    const bool nothing = code || range_um == OLD_SICK_NOTHING_UM;
    ale_scan_set_range(scan, beam, nothing ? 0 : range_um);
}
