#include "lcm/convert.h"

#include <math.h>
#include <string.h>

#include "base/fixed.h"
#include "lcm/wheel_words.h"

#define RADIANS_PER_BAM 1.4629180792671596e-9
#define INFORMATION_PER_SI (1e6 / 1048576.0) /* 2^20 per 1/mm^2 or 1/mrad^2, to 1/m^2 or 1/rad^2 */

float ale_to_metres(int64_t um)
{
    return (float)((double)um * 1e-6);
}

float ale_to_radians(uint32_t angle_bam)
{
    return (float)((int32_t)angle_bam * RADIANS_PER_BAM);
}

uint32_t ale_from_radians(double angle)
{
    return (uint32_t)llround(remainder(angle, 2 * M_PI) / RADIANS_PER_BAM);
}

int32_t ale_from_metres(double metres)
{
    return (int32_t)lround(fmax(fmin(metres * 1e6, INT32_MAX), -INT32_MAX));
}

/* Covariance of (angle, distance) or of (x, y): first, mixed, second. */
static void convert_line_cov(int64_t aa_nrad2, int64_t ar_um_nrad, int64_t rr_um2, float out[3])
{
    out[0] = (float)((double)aa_nrad2 * 1e-18);
    out[1] = (float)((double)ar_um_nrad * 1e-15);
    out[2] = (float)((double)rr_um2 * 1e-12);
}

static void convert_point_cov(const int64_t cov_um2[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = (float)((double)cov_um2[k] * 1e-12);
    }
}

static void convert_pose_cov(const int64_t cov[9], float out[9])
{
    for (int k = 0; k < 9; k++) {
        const int angles = (k / 3 == 2) + (k % 3 == 2);
        const double unit = angles == 0 ? 1e-12 : (angles == 1 ? 1e-15 : 1e-18);
        out[k] = (float)((double)cov[k] * unit);
    }
}

void ale_convert_pose(const ale_pose_report_t *report, lcmtypes_ale_pose_t *message)
{
    const ale_estimate_t *estimate = &report->estimate;
    *message = (lcmtypes_ale_pose_t){
        .utime = estimate->stamp_us,
        .scan = (int32_t)estimate->scan,
        .x = ale_to_metres(estimate->smooth.x_um),
        .y = ale_to_metres(estimate->smooth.y_um),
        .theta = ale_to_radians(estimate->smooth.theta_bam),
        .map_x = ale_to_metres(estimate->map.x_um),
        .map_y = ale_to_metres(estimate->map.y_um),
        .map_theta = ale_to_radians(estimate->map.theta_bam),
        .vx = ale_to_metres(estimate->velocity_x_um_s),
        .vy = ale_to_metres(estimate->velocity_y_um_s),
        .omega = ale_to_metres(estimate->velocity_theta_urad_s),
        .state = (int8_t)estimate->state,
        .predicted = estimate->predicted ? 1 : 0,
        .lag_us = estimate->lag_us,
        .age_us = (int32_t)ale_clamp64(report->sent_us - estimate->stamp_us, 0, INT32_MAX),
        .first_beam_utime = report->first_beam_us,
        .arrival_utime = report->arrival_us,
    };
    convert_pose_cov(estimate->cov, message->cov);
    for (int k = 0; k < 6; k++) {
        message->observability[k] = (float)((double)estimate->information[k] * INFORMATION_PER_SI);
    }
    memcpy(message->stage_ns, report->stage_ns, sizeof message->stage_ns);
    memcpy(message->stage_start_ns, report->stage_start_ns, sizeof message->stage_start_ns);
    memcpy(message->stage_end_ns, report->stage_end_ns, sizeof message->stage_end_ns);
}

void ale_convert_tracking(const ale_estimate_t *estimate, lcmtypes_ale_tracking_t *message)
{
    *message = (lcmtypes_ale_tracking_t){
        .utime = estimate->stamp_us,
        .scan = (int32_t)estimate->scan,
        .map_id = (int32_t)estimate->map_id,
        .maps = estimate->maps,
        .wheel_fault = (int8_t)estimate->wheel_fault,
        .wheel_word = (char *)ale_wheel_fault_word(estimate->wheel_fault),
        .wheel_faults = (int32_t)estimate->wheel_faults,
    };
}

static void convert_line(const ale_line_t *line, lcmtypes_ale_line_t *message)
{
    *message = (lcmtypes_ale_line_t){
        .x1 = ale_to_metres(line->start.x_um),
        .y1 = ale_to_metres(line->start.y_um),
        .x2 = ale_to_metres(line->end.x_um),
        .y2 = ale_to_metres(line->end.y_um),
        .alpha = ale_to_radians(line->alpha_bam),
        .rho = ale_to_metres(line->rho_um),
        .rmse = ale_to_metres(line->rmse_um),
        .first = (int16_t)line->first,
        .last = (int16_t)line->last,
        .first_end = (int8_t)line->first_end,
        .last_end = (int8_t)line->last_end,
    };
    convert_line_cov(line->var_alpha_nrad2, line->cov_alpha_rho, line->var_rho_um2, message->cov);
}

static void convert_corner(const ale_corner_t *corner, lcmtypes_ale_corner_t *message)
{
    *message = (lcmtypes_ale_corner_t){
        .x = ale_to_metres(corner->p.x_um),
        .y = ale_to_metres(corner->p.y_um),
        .angle = (float)(corner->angle_bam * RADIANS_PER_BAM),
        .kind = (int8_t)corner->kind,
        .first_line = (int16_t)corner->first_line,
        .second_line = (int16_t)corner->second_line,
    };
    convert_point_cov(corner->cov_um2, message->cov);
}

void ale_convert_features(const ale_features_t *features, int64_t utime, uint32_t scan, ale_pose_t sensor,
                          ale_features_buffer_t *buffer, lcmtypes_ale_features_t *message)
{
    *message = (lcmtypes_ale_features_t){
        .utime = utime,
        .scan = (int32_t)scan,
        .sensor_x = ale_to_metres(sensor.x_um),
        .sensor_y = ale_to_metres(sensor.y_um),
        .sensor_theta = ale_to_radians(sensor.theta_bam),
        .num_lines = features->line_count,
        .lines = buffer->line,
        .num_corners = features->corner_count,
        .corners = buffer->corner,
    };
    for (int k = 0; k < features->line_count; k++) {
        convert_line(&features->line[k], &buffer->line[k]);
    }
    for (int k = 0; k < features->corner_count; k++) {
        convert_corner(&features->corner[k], &buffer->corner[k]);
    }
}

/* Smallest whole number of millimetres in which the farthest range of the sensor fits 16 bits. */
static int16_t range_unit_mm(const ale_scan_t *scan)
{
    return (int16_t)(1 + scan->range_max_um / 1000 / INT16_MAX);
}

static uint8_t beam_code(const ale_scan_t *scan, int beam)
{
    if (scan->flag[beam] == ALE_BEAM_VALID) {
        return 0;
    }
    return scan->code[beam] ? scan->code[beam] : (uint8_t)(0x80 | scan->flag[beam]);
}

void ale_convert_scan(const ale_scan_t *scan, int64_t utime, uint32_t number, ale_pose_t sensor,
                      ale_scan_buffer_t *buffer, lcmtypes_ale_scan_t *message)
{
    *message = (lcmtypes_ale_scan_t){
        .utime = utime,
        .scan = (int32_t)number,
        .stamp_beam = scan->stamp_beam,
        .beam_time_us = (float)(scan->beam_time_ns * 1e-3),
        .first_bearing = ale_to_radians(scan->first_bearing_bam),
        .step = ale_to_radians((uint32_t)scan->step_bam),
        .range_min = ale_to_metres(scan->range_min_um),
        .range_max = ale_to_metres(scan->range_max_um),
        .sensor_x = ale_to_metres(sensor.x_um),
        .sensor_y = ale_to_metres(sensor.y_um),
        .sensor_theta = ale_to_radians(sensor.theta_bam),
        .num_ranges = scan->beams,
        .range_mm = buffer->range,
        .range_unit_mm = range_unit_mm(scan),
        .num_codes = scan->beams,
        .codes = buffer->code,
    };
    const int32_t unit_um = message->range_unit_mm * 1000;
    for (int k = 0; k < scan->beams; k++) {
        const bool valid = scan->flag[k] == ALE_BEAM_VALID;
        const int64_t range = valid ? ale_round_div(scan->range_um[k], unit_um) : 0;
        buffer->range[k] = (int16_t)ale_clamp64(range, 0, INT16_MAX);
        buffer->code[k] = beam_code(scan, k);
    }
}

/* Lines come first, each part full, then corners in parts of their own. */
static int line_parts(const ale_map_t *map)
{
    return (map->line_count + ALE_MAP_PART_LINES - 1) / ALE_MAP_PART_LINES;
}

int16_t ale_map_parts(const ale_map_t *map)
{
    const int corner_parts = (map->corner_count + ALE_MAP_PART_CORNERS - 1) / ALE_MAP_PART_CORNERS;
    const int parts = line_parts(map) + corner_parts;
    return (int16_t)(parts > 0 ? parts : 1);
}

static void convert_map_line(const ale_map_line_t *line, lcmtypes_ale_map_line_t *message)
{
    *message = (lcmtypes_ale_map_line_t){
        .id = (int32_t)line->id,
        .x1 = ale_to_metres(line->start.x_um),
        .y1 = ale_to_metres(line->start.y_um),
        .x2 = ale_to_metres(line->end.x_um),
        .y2 = ale_to_metres(line->end.y_um),
        .seen = (int32_t)line->seen,
    };
    convert_line_cov(line->var_alpha_nrad2, line->cov_alpha_rho, line->var_rho_um2, message->cov);
}

static void convert_map_corner(const ale_map_corner_t *corner, lcmtypes_ale_corner_t *message)
{
    *message = (lcmtypes_ale_corner_t){
        .x = ale_to_metres(corner->p.x_um),
        .y = ale_to_metres(corner->p.y_um),
        .angle = (float)(corner->angle_bam * RADIANS_PER_BAM),
        .kind = (int8_t)corner->kind,
        .first_line = -1,
        .second_line = -1,
    };
    convert_point_cov(corner->cov_um2, message->cov);
}

void ale_convert_map(const ale_map_t *map, int64_t utime, int16_t part, ale_map_buffer_t *buffer,
                     lcmtypes_ale_map_t *message)
{
    const int first_line = part * ALE_MAP_PART_LINES;
    const int first_corner = (part - line_parts(map)) * ALE_MAP_PART_CORNERS;
    *message = (lcmtypes_ale_map_t){
        .utime = utime,
        .version = (int32_t)map->version,
        .part = part,
        .parts = ale_map_parts(map),
        .num_lines = (int32_t)ale_clamp64(map->line_count - first_line, 0, ALE_MAP_PART_LINES),
        .lines = buffer->line,
        .corners = buffer->corner,
    };
    for (int k = 0; k < message->num_lines; k++) {
        convert_map_line(&map->line[first_line + k], &buffer->line[k]);
    }
    if (first_corner >= 0) {
        message->num_corners =
            (int32_t)ale_clamp64(map->corner_count - first_corner, 0, ALE_MAP_PART_CORNERS);
    }
    for (int k = 0; k < message->num_corners; k++) {
        convert_map_corner(&map->corner[first_corner + k], &buffer->corner[k]);
    }
}

static bool is_apart(const ale_map_line_t *line)
{
    return line->map_id != 0;
}

int16_t ale_map_pieces_parts(const ale_map_t *map)
{
    int apart = 0;
    for (int k = 0; k < map->line_count; k++) {
        apart += is_apart(&map->line[k]);
    }
    return (int16_t)ale_max64((apart + ALE_PIECES_PART_LINES - 1) / ALE_PIECES_PART_LINES, 1);
}

void ale_convert_map_pieces(const ale_map_t *map, int64_t utime, int16_t part, ale_pieces_buffer_t *buffer,
                            lcmtypes_ale_map_pieces_t *message)
{
    int before = part * ALE_PIECES_PART_LINES; /* lines of the parts before this one */
    *message = (lcmtypes_ale_map_pieces_t){
        .utime = utime,
        .version = (int32_t)map->version,
        .part = part,
        .parts = ale_map_pieces_parts(map),
        .line_id = buffer->line_id,
        .map_id = buffer->map_id,
    };
    for (int k = 0; k < map->line_count && message->num_lines < ALE_PIECES_PART_LINES; k++) {
        if (is_apart(&map->line[k]) && before-- <= 0) {
            buffer->line_id[message->num_lines] = (int32_t)map->line[k].id;
            buffer->map_id[message->num_lines++] = (int32_t)map->line[k].map_id;
        }
    }
}

static void convert_times(const int64_t *times_ns, float *times_us)
{
    for (int k = 0; k < ALE_STATUS_STAGES; k++) {
        times_us[k] = (float)((double)times_ns[k] * 1e-3);
    }
}

static void convert_operation(const ale_operation_report_t *report, lcmtypes_ale_status_t *message)
{
    message->robot = (char *)report->robot;
    message->takes_commands = report->takes_commands ? 1 : 0;
    message->who_drives = (char *)report->who_drives;
    message->exploration = (char *)report->exploration;
    message->map_frozen = report->map_frozen ? 1 : 0;
    message->command_operator = (char *)report->command_operator;
    message->command_counter = report->command_counter;
    message->command_obeyed = report->command_obeyed ? 1 : 0;
    message->command_result = (char *)report->command_result;
}

void ale_convert_plan(const ale_plan_report_t *report, ale_plan_buffer_t *buffer,
                      lcmtypes_ale_plan_t *message)
{
    *message = (lcmtypes_ale_plan_t){
        .utime = report->now_us,
        .state = (int8_t)report->state,
        .words = (char *)report->words,
        .has_place = report->has_place ? 1 : 0,
        .place_x = ale_to_metres(report->place.x_um),
        .place_y = ale_to_metres(report->place.y_um),
        .num_points = (int32_t)report->points,
        .x = buffer->x,
        .y = buffer->y,
    };
    for (uint32_t k = 0; k < report->points; k++) {
        buffer->x[k] = ale_to_metres(report->point[k].x_um);
        buffer->y[k] = ale_to_metres(report->point[k].y_um);
    }
}

static void convert_keyframe(const ale_graph_keyframe_t *keyframe, uint32_t k, ale_graph_buffer_t *buffer)
{
    buffer->scan[k] = (int32_t)keyframe->scan;
    buffer->x[k] = ale_to_metres(keyframe->pose.x_um);
    buffer->y[k] = ale_to_metres(keyframe->pose.y_um);
    buffer->theta[k] = ale_to_radians(keyframe->pose.theta_bam);
    buffer->map_id[k] = (int32_t)keyframe->map_id;
    buffer->tied[k] = keyframe->tied ? 1 : 0;
}

void ale_convert_graph(const ale_mapper_graph_t *graph, int64_t utime, uint32_t version,
                       ale_graph_buffer_t *buffer, lcmtypes_ale_graph_t *message)
{
    *message = (lcmtypes_ale_graph_t){
        .utime = utime,
        .version = (int32_t)version,
        .keyframes_left_out = (int32_t)graph->keyframes_left_out,
        .loops_left_out = (int32_t)graph->loops_left_out,
        .num_keyframes = (int32_t)graph->keyframes,
        .scan = buffer->scan,
        .x = buffer->x,
        .y = buffer->y,
        .theta = buffer->theta,
        .map_id = buffer->map_id,
        .tied = buffer->tied,
        .num_loops = (int32_t)graph->loops,
        .loop_from = buffer->loop_from,
        .loop_to = buffer->loop_to,
        .loop_kind = buffer->loop_kind,
    };
    for (uint32_t k = 0; k < graph->keyframes; k++) {
        convert_keyframe(&graph->keyframe[k], k, buffer);
    }
    for (uint32_t k = 0; k < graph->loops; k++) {
        buffer->loop_from[k] = (int16_t)graph->loop[k].from;
        buffer->loop_to[k] = (int16_t)graph->loop[k].to;
        buffer->loop_kind[k] = (int8_t)graph->loop[k].kind;
    }
}

void ale_convert_status(const ale_status_report_t *report, ale_status_buffer_t *buffer,
                        lcmtypes_ale_status_t *message)
{
    *message = (lcmtypes_ale_status_t){
        .utime = report->now_us,
        .boot = report->boot,
        .scans = (int32_t)report->scans,
        .poses = (int32_t)report->poses,
        .state = (int8_t)report->state,
        .latency_p50_us = (float)((double)report->latency_p50_ns * 1e-3),
        .latency_p99_us = (float)((double)report->latency_p99_ns * 1e-3),
        .latency_worst_us = (float)((double)report->latency_worst_ns * 1e-3),
        .deadline_misses = (int32_t)report->deadline_misses,
        .realtime = report->realtime ? 1 : 0,
        .realtime_detail = (char *)report->realtime_detail,
        .driver_state = (char *)report->driver_state,
        .device = (char *)report->device,
        .scan_rate_hz = report->scan_period_us > 0 ? 1e6f / (float)report->scan_period_us : 0,
        .num_counters = (int32_t)report->counters,
        .counter_name = buffer->name,
        .counter_value = buffer->value,
    };
    convert_operation(&report->operation, message);
    convert_times(report->stage_last_ns, message->stage_last_us);
    convert_times(report->stage_p99_ns, message->stage_p99_us);
    convert_times(report->stage_worst_ns, message->stage_worst_us);
    for (uint32_t k = 0; k < report->counters; k++) {
        buffer->name[k] = (char *)report->counter[k].name;
        buffer->value[k] = (int64_t)report->counter[k].value;
    }
}

void ale_convert_odometry(const ale_odometry_t *sample, lcmtypes_ale_odometry_t *message)
{
    *message = (lcmtypes_ale_odometry_t){
        .utime = sample->stamp_us,
        .x = ale_to_metres(sample->pose.x_um),
        .y = ale_to_metres(sample->pose.y_um),
        .theta = ale_to_radians(sample->pose.theta_bam),
    };
}

int ale_take_odometry(const lcmtypes_ale_odometry_t *message, ale_odometry_t *sample)
{
    const float farthest = 2000;
    const float widest = 1e6f;
    const bool sane = fabsf(message->x) <= farthest && fabsf(message->y) <= farthest &&
                      fabsf(message->theta) <= widest && message->utime > 0 &&
                      message->utime <= ALE_MAX_STAMP_US; /* false for NaN too */
    if (!sane) {
        return -1;
    }
    *sample = (ale_odometry_t){
        .stamp_us = message->utime,
        .pose = {.x_um = ale_from_metres((double)message->x),
                 .y_um = ale_from_metres((double)message->y),
                 .theta_bam = ale_from_radians((double)message->theta)},
    };
    return 0;
}
