#include "system/async_logger.h"

#include <stdlib.h>

#include "exchange/ring.h"
#include "system/background.h"

#define LOOK_NS 1000000000

enum { LINES = 16 };

typedef struct {
    char words[ALE_SPEAKER_LINE];
} line_t;

struct ale_speaker {
    FILE *out;
    ale_ring_t *lines; /* line_t */
    uint32_t told;     /* of those left out */
    ale_background_t thread;
};

static void write_line(ale_speaker_t *speaker, const char *words)
{
    fprintf(speaker->out, "ale-slamd: %s\n", words);
    fflush(speaker->out);
}

/* There is room again. */
static void tell_left_out(ale_speaker_t *speaker)
{
    const uint32_t fresh = ale_speaker_left_out(speaker) - speaker->told;
    if (fresh > 0) {
        char words[ALE_SPEAKER_LINE];
        snprintf(words, sizeof words, "%u line%s left out here: nobody took them in time", fresh,
                 fresh == 1 ? "" : "s");
        write_line(speaker, words);
        speaker->told += fresh;
    }
}

static void write_out(ale_speaker_t *speaker)
{
    while (ale_ring_ready(speaker->lines) > 0) {
        write_line(speaker, ((const line_t *)ale_ring_at(speaker->lines, 0))->words);
        ale_ring_release(speaker->lines);
    }
    tell_left_out(speaker);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_speaker_t *speaker = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&speaker->thread, LOOK_NS);
        write_out(speaker);
    }
    write_out(speaker);
}

ale_speaker_t *ale_speaker_start(FILE *out)
{
    ale_speaker_t *speaker = calloc(1, sizeof *speaker);
    if (!speaker) {
        return NULL;
    }
    speaker->out = out;
    speaker->lines = ale_ring_create(sizeof(line_t), LINES);
    if (!speaker->lines || ale_background_start(&speaker->thread, "ale-speaker", run, speaker, 0) < 0) {
        ale_speaker_stop(speaker);
        return NULL;
    }
    return speaker;
}

void ale_speaker_stop(ale_speaker_t *speaker)
{
    if (speaker) {
        ale_background_stop(&speaker->thread);
        ale_ring_destroy(speaker->lines);
        free(speaker);
    }
}

void ale_speaker_say(ale_speaker_t *speaker, const char *words)
{
    line_t *line = ale_ring_reserve(speaker->lines);
    if (line) {
        snprintf(line->words, sizeof line->words, "%s", words);
        ale_ring_commit(speaker->lines);
        ale_background_wake(&speaker->thread);
    }
}

uint32_t ale_speaker_left_out(const ale_speaker_t *speaker)
{
    return ale_ring_refused(speaker->lines);
}
