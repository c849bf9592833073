/* A recording that is played over the line says so (line PLAY of PP), and what SCIP has no word for: how its
 * scans lie in bearing and time, and how long none may come. Its stamps are those of the recording, unevenly
 * spaced and out of order as they are, on the clock of the odometry that is played with them: nothing has to
 * be estimated from when bytes arrive, which a simulator that runs fast would multiply. */
#ifndef ALE_SCANNER_URG_PLAYED_H
#define ALE_SCANNER_URG_PLAYED_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "scanner/urg/scip_request.h"

typedef struct {
    int32_t silence_ms; /* longest time without a scan, and some; 0: no recording is played */
    int64_t zero_us;    /* where the counter of the stamps was 0; on the line: the clock of messages */
    int32_t tick_us;    /* which counts these, in 24 bits */
    int32_t stamp_step; /* step that the stamp belongs to; outside the scan, too */
    int32_t step_ns;    /* from step to step; 0: a scan was taken at once */
    int32_t origin_bam; /* bearing of step 0 */
    int32_t step_bam;
    int32_t blind_before; /* steps before this one, and from the other on, look at the robot itself where */
    int32_t blind_from;   /* nothing returns */
} ale_urg_played_t;       /* all zero: none is played */

enum { ALE_URG_PLAYED_TEXT = 112 };

/* For those who have no clock of messages: zero_us is found when the first scan comes. */
#define ALE_URG_PLAYED_ZERO_UNKNOWN INT64_MIN

/* The value of PLAY, and back. Parsing: false when it is none; out is changed only when it is one. */
void ale_urg_played_format(const ale_urg_played_t *played, char text[ALE_URG_PLAYED_TEXT]);
bool ale_urg_played_parse(const char *text, ale_urg_played_t *out);

/* Time of a stamp, on the clock of zero_us: not long before it came, for a counter of 24 bits comes round. */
int64_t ale_urg_played_us(const ale_urg_played_t *played, uint32_t stamp, int64_t arrival_us);

/* Gives the answer to a request its stamp, where its beams lie, and which of them are blind. */
void ale_urg_played_place(const ale_urg_played_t *played, const ale_scip_request_t *request, int64_t stamp_us,
                          bool reversed, ale_scan_t *scan);

#endif
