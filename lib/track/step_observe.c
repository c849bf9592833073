#include "track/step_observe.h"

#include <string.h>

#include "motion/deskew.h"
#include "observe/short_segment.h"
#include "track/step_filter.h"

ale_scene_t ale_observed_scene(ale_pipeline_t *p)
{
    const ale_observed_t *o = &p->observed;
    return (ale_scene_t){&p->map, o->observation, o->count, o->velocity};
}

static void straighten(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES])
{
    ale_observed_t *o = &p->observed;
    int32_t sensor_velocity[ALE_AXES];
    o->scan = *raw;
    memcpy(o->velocity, velocity, sizeof o->velocity);
    ale_scan_mask(&o->scan, p->config.blind, p->config.blind_count);
    ale_filter_mask(p, &o->scan);
    if (ale_scan_is_sparse(&o->scan)) {
        ale_scan_forgive_missing(&o->scan);
    }
    ale_sensor_velocity(velocity, p->config.sensor, sensor_velocity);
    o->straightened = ale_deskew(&o->scan, sensor_velocity, o->bearing_bam);
}

void ale_step_observe(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES])
{
    ale_observed_t *o = &p->observed;
    straighten(p, raw, velocity);
    const ale_posed_scan_t from = {&o->scan, ale_observed_bearings(o), p->config.sensor};
    ale_stage_end(&p->hook, ALE_STAGE_DESKEW);
    ale_extract_scan(&p->extractor, &o->scan, from.bearing_bam, &o->features);
    const ale_noise_t noise = ale_extractor_noise(&p->extractor);
    o->count =
        ale_observe_lines(&o->features, &o->scan, p->config.sensor, noise.surface_um / 2, o->observation);
    o->count += ale_observe_segments(&o->features, &from, &noise, &p->segments,
                                     ALE_MAX_OBSERVATIONS - o->count, &o->observation[o->count]);
}
