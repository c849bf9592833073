/* Flight recordings on disk: one file an event, whole or not at all, the oldest removed. May block for as
 * long as the disk takes: for an ordinary thread. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_FILE_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_FILE_H

#include "recorder/flight_ring.h"

enum { ALE_FLIGHT_FILES = 10, ALE_FLIGHT_MESSAGE = 512 };

/* Writes folder/flight-TIME-REASON.scip (TIME in UTC): the configuration in force, then the ring; then
 * removes all but the newest ALE_FLIGHT_FILES of the folder. 0, or -1; message: one line for people, either
 * way. */
int ale_flight_file_write(const char *folder, const char *reason, const char *config,
                          const ale_flight_ring_t *ring, char message[ALE_FLIGHT_MESSAGE]);

#endif
