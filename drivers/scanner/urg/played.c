#include "scanner/urg/played.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fixed.h"

enum { FIELDS = 9, STAMP_STEP = 3, STEP_NS = 4, STEP_BAM = 6, STAMPS = 1 << 24, AHEAD_US = 1000000 };

/* What is beyond is no recording of a scanner; with these the times of a scan's beams fit 32 bits. */
static const struct {
    int64_t least;
    int64_t most;
} limits[FIELDS] = {{1, 10000000},
                    {-(INT64_C(1) << 60), INT64_C(1) << 60},
                    {1, 1000},
                    {-20000, 20000},
                    {0, 10000000},
                    {INT32_MIN, INT32_MAX},
                    {INT32_MIN, INT32_MAX},
                    {0, 20000},
                    {0, 20000}};

void ale_urg_played_format(const ale_urg_played_t *p, char text[ALE_URG_PLAYED_TEXT])
{
    snprintf(text, ALE_URG_PLAYED_TEXT,
             "%" PRId32 ",%" PRId64 ",%" PRId32 ",%" PRId32 ",%" PRId32 ",%" PRId32 ",%" PRId32 ",%" PRId32
             ",%" PRId32,
             p->silence_ms, p->zero_us, p->tick_us, p->stamp_step, p->step_ns, p->origin_bam, p->step_bam,
             p->blind_before, p->blind_from);
}

/* The integers between commas, and nothing else. */
static bool read_fields(const char *text, int64_t field[FIELDS])
{
    for (int k = 0; k < FIELDS; k++) {
        char *end = NULL;
        field[k] = strtoll(text, &end, 10);
        if (end == text || *end != (k + 1 < FIELDS ? ',' : '\0') || field[k] < limits[k].least ||
            field[k] > limits[k].most) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

bool ale_urg_played_parse(const char *text, ale_urg_played_t *out)
{
    int64_t field[FIELDS];
    if (!read_fields(text, field) || field[STEP_BAM] == 0 ||
        (ale_abs64(field[STAMP_STEP]) + ALE_MAX_BEAMS) * field[STEP_NS] > 1000LL * ALE_MAX_SWEEP_US) {
        return false;
    }
    *out = (ale_urg_played_t){.silence_ms = (int32_t)field[0],
                              .zero_us = field[1],
                              .tick_us = (int32_t)field[2],
                              .stamp_step = (int32_t)field[3],
                              .step_ns = (int32_t)field[4],
                              .origin_bam = (int32_t)field[5],
                              .step_bam = (int32_t)field[STEP_BAM],
                              .blind_before = (int32_t)field[7],
                              .blind_from = (int32_t)field[8]};
    return true;
}

int64_t ale_urg_played_us(const ale_urg_played_t *played, uint32_t stamp, int64_t arrival_us)
{
    const int64_t span_us = (int64_t)STAMPS * played->tick_us;
    const int64_t stamp_us = played->zero_us + (int64_t)stamp * played->tick_us;
    const int64_t passed_us = (arrival_us + AHEAD_US - stamp_us) % span_us;
    return arrival_us + AHEAD_US - (passed_us < 0 ? passed_us + span_us : passed_us);
}

/* Beams from..to-1 that nothing returns to: there is the robot itself. */
static void blind(ale_scan_t *scan, int64_t from, int64_t to)
{
    for (int64_t k = ale_max64(from, 0); k < ale_min64(to, scan->beams); k++) {
        if (scan->flag[k] == ALE_BEAM_NO_RETURN) {
            scan->flag[k] = ALE_BEAM_BLIND;
        }
    }
}

void ale_urg_played_place(const ale_urg_played_t *played, const ale_scip_request_t *request, int64_t stamp_us,
                          bool reversed, ale_scan_t *scan)
{
    const int32_t cluster = request->cluster > 1 ? request->cluster : 1;
    const int32_t sign = reversed ? -1 : 1;
    /* Middle of the first beam, in half steps from step 0. */
    const int64_t middle = 2 * (int64_t)request->first_step + cluster - 1;
    const int64_t bearing_bam = played->origin_bam + ale_round_div(middle * played->step_bam, 2);
    scan->stamp_us = stamp_us;
    scan->stamp_beam = (int32_t)ale_round_div(2 * (int64_t)played->stamp_step - middle, (int64_t)2 * cluster);
    scan->beam_time_ns = (int32_t)ale_min64((int64_t)played->step_ns * cluster, INT32_MAX);
    scan->first_bearing_bam = (uint32_t)(uint64_t)(sign * bearing_bam);
    scan->step_bam = (int32_t)(uint32_t)(uint64_t)(sign * (int64_t)cluster * played->step_bam);
    blind(scan, 0, (played->blind_before - request->first_step) / cluster);
    blind(scan, (played->blind_from - request->first_step) / cluster, scan->beams);
}
