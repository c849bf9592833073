/* The clock of whoever sends stamped messages, in the robot's time.
 *
 * A computer without a clock of its own starts in 1970, a network sets it, its quartz runs by 100 ppm off:
 * stamps of another computer, or of this one after its date was set, are of a clock of their own. Each
 * message gives one sample arrival - stamp  =  offset of the clocks + delay on the way,   delay >= 0 of which
 * the least of some seconds is the best.
 *
 *   A clock that agrees with the robot's to 100 ms is the robot's: stamps count as they are, and a delay is
 *   believed.
 *   One that does not is followed: its fastest message has taken no time.
 *   One that goes, and nobody steps it, is followed by what the least delay grows or falls.
 *   One that was stepped (stamps disagree by half a second or more) counts anew, as soon as three messages
 *   within a fifth of a second or more agree on it; those before are refused.
 *
 * Integers only, constant work, no clock is read. Times are of the robot's clock, whose seconds may be
 * shorter than real ones (simulations): `scale_ppm` parts of a million of it pass in a microsecond. */
#ifndef ALE_LCM_SENDER_CLOCK_H
#define ALE_LCM_SENDER_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum { ALE_SENDER_BLOCKS = 8 }; /* of a second each: window of the least delay */

/* Fields are private, but for reading. */
typedef struct {
    int32_t scale_ppm;
    bool started;
    bool same;          /* as the robot's, but for drift */
    int64_t offset_us;  /* robot's time of a stamp minus the stamp */
    int64_t most_us;    /* the least delay that is believed; beyond it the clock has drifted */
    int64_t stamp_us;   /* of the last message that was taken */
    int64_t arrival_us; /* of the last message */
    uint32_t steps;     /* so often the clock was stepped, */
    int64_t step_us;    /* and by how much at last: ahead is positive */
    uint64_t blocks_seen;
    int64_t block_begin_us;
    int64_t least_us[ALE_SENDER_BLOCKS]; /* of each second, a ring */
    int32_t witnesses;                   /* messages in a row that agree on another offset, */
    int64_t witnesses_since_us;
    int64_t witnessed_us; /* the least of them */
} ale_sender_clock_t;

/* Nothing heard yet. scale_ppm: 1000000 for real time. */
void ale_sender_clock_init(ale_sender_clock_t *clock, int32_t scale_ppm);

/* Takes a message's stamp and its arrival. stamp_us: as the robot would read it, were it by its own clock
 * (both within 2^61). True, and when it was in *time_us; false while it agrees with no clock, *time_us is
 * untouched. */
bool ale_sender_clock_take(ale_sender_clock_t *clock, int64_t stamp_us, int64_t arrival_us, int64_t *time_us);

#endif
