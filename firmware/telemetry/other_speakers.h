/* Who else speaks on this robot's channels: another ale-slamd that was started by mistake, or another robot
 * on the same network. Each start is known by its boot nonce (ALE_SPEAKER). Pure: messages and time come in,
 * texts go out. */
#ifndef ALE_FIRMWARE_TELEMETRY_OTHER_SPEAKERS_H
#define ALE_FIRMWARE_TELEMETRY_OTHER_SPEAKERS_H

#include <stdbool.h>
#include <stdint.h>

#include "lcm/report.h"

enum { ALE_OTHER_SPEAKERS = 4, ALE_SPEAKERS_LINE = 320 };

typedef struct {
    ale_speaker_t who; /* boot 0: nobody */
    int64_t heard_ns;
    bool told;
} ale_other_speaker_t;

typedef struct {
    ale_speaker_t self; /* what this one says of itself, but for the time */
    ale_other_speaker_t other[ALE_OTHER_SPEAKERS];
    int64_t next_word_ns;
} ale_other_speakers_t;

/* Nobody heard yet. */
void ale_other_speakers_init(ale_other_speakers_t *others, int64_t boot, const char *robot);

/* Takes what somebody says, also what this one has said itself. One more than there is room for takes the
 * place of who was heard of the longest ago. */
void ale_other_speakers_take(ale_other_speakers_t *others, const ale_speaker_t *speaker, int64_t now_ns);

/* True when there is something to say: a start of another one, once each, and at most once in ten seconds. */
bool ale_other_speakers_word(ale_other_speakers_t *others, int64_t now_ns, char line[ALE_SPEAKERS_LINE]);

/* How many were heard in the last three seconds. */
uint32_t ale_other_speakers_count(const ale_other_speakers_t *others, int64_t now_ns);

#endif
