/* The first part of a scan's way: from raw ranges to what they show. */
#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "motion/deskew.h"
#include "observe/short_segment.h"
#include "track/pipeline_steps.h"

/* The noise model with the beams' own noise as the extractor found it in this scan. */
static ale_noise_t measured_noise(const ale_pipeline_t *p)
{
    ale_noise_t noise = p->config.extract.noise;
    const ale_scan_noise_t *found = &p->extractor.noise;
    noise.own_um = (int32_t)ale_isqrt((uint64_t)ale_mul_shift(found->own_mm2_q36, 1000000, 36));
    noise.own_ppm = (int32_t)ale_isqrt((uint64_t)ale_mul_shift(found->own_relative_q36, 1000000000000, 36));
    return noise;
}

const uint32_t *ale_pipeline_bearings(const ale_pipeline_t *p)
{
    return p->straightened ? p->bearing_bam : NULL;
}

/* Whether the scan at hand was taken where the pose says: not while lost, nor while scans are denied by one
 * that was taken beside them, which is called weak until it is called lost. */
static bool is_placed(const ale_pipeline_t *p)
{
    return p->monitor.state != ALE_STATE_LOST && !(p->monitor.jumped && p->monitor.beside);
}

bool ale_pipeline_seen(const ale_pipeline_t *p, ale_seen_t *out)
{
    if (!p->looked || !is_placed(p)) {
        return false;
    }
    *out = (ale_seen_t){.scan = &p->scan,
                        .bearing_bam = ale_pipeline_bearings(p),
                        .robot = p->motion.pose,
                        .sensor = ale_pose_compose(p->motion.pose, p->config.sensor),
                        .observation = p->observation,
                        .observation_count = p->observation_count};
    return true;
}

void ale_pipeline_preprocess(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES])
{
    int32_t sensor_velocity[ALE_AXES];
    p->scan = *raw;
    p->looked = true;
    memcpy(p->velocity, velocity, sizeof p->velocity);
    ale_scan_mask(&p->scan, p->config.blind, p->config.blind_count);
    ale_carried_mask(&p->carried, &p->scan);
    ale_sensor_velocity(velocity, p->config.sensor, sensor_velocity);
    p->straightened = ale_deskew(&p->scan, sensor_velocity, p->bearing_bam);
    const uint32_t *bearing_bam = ale_pipeline_bearings(p);
    ale_stage_end(&p->hook, ALE_STAGE_DESKEW);
    ale_extract_scan(&p->extractor, &p->scan, bearing_bam, &p->features);
    const ale_noise_t noise = measured_noise(p);
    p->observation_count =
        ale_observe_lines(&p->features, &p->scan, p->config.sensor, noise.surface_um / 2, p->observation);
    p->observation_count += ale_observe_segments(
        &p->features, &p->scan, bearing_bam, p->config.sensor, &noise, &p->segments,
        ALE_MAX_OBSERVATIONS - p->observation_count, &p->observation[p->observation_count]);
}
