/* What a flight recording says of one scan, for people and for those who compare a replay with the flight:
 * lines of `name=value` words, whole numbers, units in the names. Pure functions. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_WORDS_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_WORDS_H

#include "exchange/exchange.h"
#include "recorder/flight_ring.h"

/* The part of a result that is kept. */
typedef struct {
    ale_estimate_t estimate;
    int64_t first_beam_us;
    int64_t arrival_us;
    int32_t stage_ns[ALE_STAGES];
    int32_t stage_start_ns[ALE_STAGES];
    int32_t stage_end_ns[ALE_STAGES];
    int32_t total_ns;
    uint32_t overloaded;
    uint32_t late;
    uint32_t odometry_taken;
    uint16_t lines;
    uint16_t corners;
} ale_flight_result_t;

ale_flight_result_t ale_flight_result(const ale_result_t *result);

/* The payload of a DECISION chunk (poses, state, what was matched) and of a STAGES chunk (times). Their
 * length. */
uint32_t ale_flight_decision(const ale_flight_result_t *result, char text[ALE_FLIGHT_MAX_PAYLOAD]);
uint32_t ale_flight_stages(const ale_flight_result_t *result, char text[ALE_FLIGHT_MAX_PAYLOAD]);

#endif
