#include "telemetry/other_speakers.h"

#include <stdio.h>
#include <unistd.h>

#define LATELY_NS 3000000000
#define WORD_PERIOD_NS 10000000000

void ale_other_speakers_init(ale_other_speakers_t *others, int64_t boot, const char *robot)
{
    *others = (ale_other_speakers_t){.self = {.boot = boot, .process = (int32_t)getpid()}};
    snprintf(others->self.robot, sizeof others->self.robot, "%s", robot);
    if (gethostname(others->self.host, sizeof others->self.host - 1) < 0) {
        others->self.host[0] = '\0';
    }
}

static ale_other_speaker_t *place_of(ale_other_speakers_t *others, int64_t boot)
{
    ale_other_speaker_t *place = &others->other[0];
    for (int k = 0; k < ALE_OTHER_SPEAKERS; k++) {
        ale_other_speaker_t *other = &others->other[k];
        if (other->who.boot == boot) {
            return other;
        }
        place = other->heard_ns < place->heard_ns ? other : place;
    }
    *place = (ale_other_speaker_t){0};
    return place;
}

void ale_other_speakers_take(ale_other_speakers_t *others, const ale_speaker_t *speaker, int64_t now_ns)
{
    if (speaker->boot != others->self.boot && speaker->boot != 0) {
        ale_other_speaker_t *place = place_of(others, speaker->boot);
        place->who = *speaker;
        place->heard_ns = now_ns;
    }
}

bool ale_other_speakers_word(ale_other_speakers_t *others, int64_t now_ns, char line[ALE_SPEAKERS_LINE])
{
    for (int k = 0; k < ALE_OTHER_SPEAKERS && now_ns >= others->next_word_ns; k++) {
        ale_other_speaker_t *other = &others->other[k];
        if (other->who.boot != 0 && !other->told) {
            other->told = true;
            others->next_word_ns = now_ns + WORD_PERIOD_NS;
            snprintf(line, ALE_SPEAKERS_LINE,
                     "another ale-slamd speaks on the same channels: robot %s on %s, process %d, boot nonce "
                     "%lld; end "
                     "one of the two, or give it channels of its own ([lcm] prefix)",
                     other->who.robot, other->who.host, other->who.process, (long long)other->who.boot);
            return true;
        }
    }
    return false;
}

uint32_t ale_other_speakers_count(const ale_other_speakers_t *others, int64_t now_ns)
{
    uint32_t count = 0;
    for (int k = 0; k < ALE_OTHER_SPEAKERS; k++) {
        count += others->other[k].who.boot != 0 && now_ns - others->other[k].heard_ns < LATELY_NS;
    }
    return count;
}
