/* Flight recordings on disk: one file an event, whole or not at all. Each reason has a share of the files,
 * and the oldest of that reason makes room: ten `record` commands remove no recording of a fault. What is
 * oldest is told by a number in the name, which a clock that is set back does not change. May block for as
 * long as the disk takes: for an ordinary thread. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_FILE_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_FILE_H

#include "recorder/flight_ring.h"

enum { ALE_FLIGHT_MESSAGE = 512 };

typedef struct {
    const char *reason; /* "fault": in the name of the file */
    int kept;           /* so many of them, the newest */
} ale_flight_kind_t;

/* Writes folder/flight-NUMBER-TIME-REASON.scip (NUMBER one above the highest there, TIME in UTC): the
 * configuration in force, then the ring; then removes all but the newest of this kind. Rights 0640. 0, or an
 * errno: then nothing is removed. message: one line for people, either way. */
int ale_flight_file_write(const char *folder, const ale_flight_kind_t *kind, const char *config,
                          const ale_flight_ring_t *ring, char message[ALE_FLIGHT_MESSAGE]);

#endif
