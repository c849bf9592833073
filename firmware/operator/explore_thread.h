/* The exploration thread: scans with their poses come in, what it wants to drive goes out, and what it is
 * doing. It explores, or drives to a place that an operator names.
 *
 *   telemetry ── scans, on or off ──► exploration ── request (newest) ──► drive
 *        ▲                                │   ▲
 *        └──────── in words (newest) ─────┘   └── corrections ── mapper
 *
 * Ordinary, and never in the estimate task's way: it hears of scans from the telemetry thread. Its requests
 * last for three scans; the drive thread decides whether they are fulfilled. */
#ifndef ALE_FIRMWARE_OPERATOR_EXPLORE_THREAD_H
#define ALE_FIRMWARE_OPERATOR_EXPLORE_THREAD_H

#include <stdbool.h>

#include "base/scan.h"
#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/report.h"
#include "track/pipeline.h"

enum { ALE_EXPLORE_REQUEST_LIFE_US = 300000 };

typedef struct ale_explore ale_explore_t;

/* Starts the thread, doing nothing yet. NULL: no memory or no thread. exchange must outlive it. */
ale_explore_t *ale_explore_start(const ale_config_t *config, ale_exchange_t *exchange);

/* Asks to stand still, then stops. NULL: nothing. */
void ale_explore_stop(ale_explore_t *explore);

/* The rest is for one thread, telemetry. */

/* A scan, blind sectors masked, with its estimate: copied when it is wanted. Times of the clock inside. Never
 * waits. */
void ale_explore_take(ale_explore_t *explore, const ale_scan_t *scan, const ale_estimate_t *estimate);

/* On: explores from here, anew unless it is at it. Off: lets go of the robot. */
void ale_explore_request(ale_explore_t *explore, bool on);

/* Drives to `place` of the map, whatever it did; map: its walls, copied; NULL: none yet. */
void ale_explore_go(ale_explore_t *explore, ale_point_t place, const ale_map_t *map);

/* True from "on" or "go" until it is over or "off". */
bool ale_explore_is_on(ale_explore_t *explore);

/* The same of a place alone. */
bool ale_explore_is_going(ale_explore_t *explore);

typedef enum { ALE_GOAL_PENDING, ALE_GOAL_TAKEN, ALE_GOAL_REFUSED } ale_goal_answer_t;

/* What has come of the newest ale_explore_go, and in words: pending until a way there is planned for the
 * first time. */
ale_goal_answer_t ale_explore_goal_answer(ale_explore_t *explore, char text[ALE_ANSWER_BYTES]);

/* What it drives by itself; report->now_us is the caller's. A number that is another one whenever there is
 * something new to tell. */
uint32_t ale_explore_plan(ale_explore_t *explore, ale_plan_report_t *report);

/* What it does, in words; empty: it is off. */
void ale_explore_words(ale_explore_t *explore, char text[ALE_ANSWER_BYTES]);

#endif
