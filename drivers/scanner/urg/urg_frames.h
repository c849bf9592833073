/* What the frames of a stream say of its health, and the ladder of recovery: restart the stream, three times;
 * reset the sensor; reopen the port. A series of good scans leads back to the foot of the ladder.
 *
 * Pure: every function returns what is to be done, and does nothing of it. */
#ifndef ALE_SCANNER_URG_URG_FRAMES_H
#define ALE_SCANNER_URG_URG_FRAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/urg/urg_action.h"
#include "scanner/urg/urg_stream.h"

/* Fields are private, but for reading. */
typedef struct {
    uint32_t failures;   /* restarts in a row without a series of good scans between */
    uint32_t bad_frames; /* in a row */
    uint32_t good_frames;
    uint32_t frozen; /* repeated stamps in a row */

    uint64_t bad_checksum; /* since the beginning */
    uint64_t bad_frame;
    uint64_t repeated;
    uint64_t hardware_faults;
    char reason[ALE_URG_REASON]; /* of an action, where it is no fixed text */
} ale_urg_frames_t;

/* A port was opened: the foot of the ladder. */
void ale_urg_frames_open(ale_urg_frames_t *frames);

/* The port was closed: good scans no longer follow each other. */
void ale_urg_frames_close(ale_urg_frames_t *frames);

/* A stream begins. */
void ale_urg_frames_begin(ale_urg_frames_t *frames);

/* A frame, and what became of it; streams: the stream is acknowledged, so that damage counts against it. */
ale_urg_action_t ale_urg_frames_take(ale_urg_frames_t *frames, ale_frame_t frame, ale_scip_loss_t loss,
                                     bool streams);

/* The series of good scans is long enough to forget all that was before. */
bool ale_urg_frames_proved(const ale_urg_frames_t *frames);

/* A frame with a status instead of ranges: 21..49 and 98 a check of the sensor, 50..97 a fault.
 * first_scan_ms: new time-out after a check. */
ale_urg_action_t ale_urg_frames_status(ale_urg_frames_t *frames, const char *status, int32_t first_scan_ms);

/* The next rung: RESTART, RESET or REOPEN. */
ale_urg_action_t ale_urg_frames_fail(ale_urg_frames_t *frames, const char *reason);

/* Time without a scan after which a stream of such a turn counts as dead. */
int32_t ale_urg_frames_silence_ms(int64_t turn_us);

#endif
