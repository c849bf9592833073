#include "system/async_logger.h"

#include <stdlib.h>
#include <time.h>

#include "exchange/ring.h"
#include "system/background.h"
#include "system/log_line.h"

#define LOOK_NS 1000000000

enum { LINES = 16 };

typedef struct {
    time_t logged_s;
    char words[ALE_LOGGER_LINE];
} line_t;

struct ale_logger {
    FILE *out;
    bool with_time;
    ale_ring_t *lines; /* line_t */
    uint32_t told;     /* of those left out */
    ale_background_t thread;
};

static void write_line(ale_logger_t *logger, const line_t *line)
{
    ale_log_write(logger->out, logger->with_time, line->logged_s, line->words);
}

/* There is room again. */
static void tell_dropped(ale_logger_t *logger)
{
    const uint32_t fresh = ale_logger_dropped(logger) - logger->told;
    if (fresh > 0) {
        line_t line = {.logged_s = time(NULL)};
        snprintf(line.words, sizeof line.words, "%u line%s left out here: nobody took them in time", fresh,
                 fresh == 1 ? "" : "s");
        write_line(logger, &line);
        logger->told += fresh;
    }
}

static void write_out(ale_logger_t *logger)
{
    while (ale_ring_ready(logger->lines) > 0) {
        write_line(logger, ale_ring_at(logger->lines, 0));
        ale_ring_release(logger->lines);
    }
    tell_dropped(logger);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_logger_t *logger = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&logger->thread, LOOK_NS);
        write_out(logger);
    }
    write_out(logger);
}

ale_logger_t *ale_logger_start(FILE *out, bool with_time)
{
    ale_logger_t *logger = calloc(1, sizeof *logger);
    if (!logger) {
        return NULL;
    }
    logger->out = out;
    logger->with_time = with_time;
    logger->lines = ale_ring_create(sizeof(line_t), LINES);
    if (!logger->lines || ale_background_start(&logger->thread, "ale-logger", run, logger, 0) < 0) {
        ale_logger_stop(logger);
        return NULL;
    }
    return logger;
}

void ale_logger_stop(ale_logger_t *logger)
{
    if (logger) {
        ale_background_stop(&logger->thread);
        ale_ring_destroy(logger->lines);
        free(logger);
    }
}

void ale_logger_log(ale_logger_t *logger, const char *words)
{
    line_t *line = ale_ring_reserve(logger->lines);
    if (line) {
        line->logged_s = time(NULL);
        snprintf(line->words, sizeof line->words, "%s", words);
        ale_ring_commit(logger->lines);
        ale_background_wake(&logger->thread);
    }
}

uint32_t ale_logger_dropped(const ale_logger_t *logger)
{
    return ale_ring_refused(logger->lines);
}
