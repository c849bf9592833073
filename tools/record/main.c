/* ale-record: what passes on the scanner's serial line, and the odometry beside it, into a .scip file. */
#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "clock.h"
#include "lcm/bus.h"
#include "record/options.h"
#include "store/recording.h"
#include "urg/urg_device.h"

enum { STEP_MS = 10, SECOND_US = 1000000 };

typedef struct {
    record_options_t options;
    ale_clock_t clock;
    ale_recording_t recording;
    int write_error; /* errno of the first write that failed */
    ale_bus_t *bus;  /* NULL without LCM */
    ale_urg_t *urg;
    uint64_t bytes_in;
    uint64_t odometry;
    int64_t begin_us; /* real time */
    int64_t told_us;
    char status[sizeof((ale_urg_health_t *)0)->status]; /* last told */
} recorder_t;

static volatile sig_atomic_t stop = 0;

static void on_signal(int number)
{
    (void)number;
    stop = 1;
}

static void catch_signals(void)
{
    struct sigaction action = {.sa_handler = on_signal};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static int64_t clock_now(void *user)
{
    return ale_clock_now_us(user);
}

static int64_t real_now_us(void)
{
    const ale_clock_t real = {.scale_ppm = ALE_CLOCK_REAL, .offset_us = 0};
    return ale_clock_now_us(&real);
}

static void note_write(recorder_t *recorder, int result)
{
    if (result < 0 && recorder->write_error == 0) {
        recorder->write_error = errno != 0 ? errno : EIO;
    }
}

static void on_bytes(void *user, bool sent, const uint8_t *bytes, uint32_t count, int64_t host_us)
{
    recorder_t *recorder = user;
    recorder->bytes_in += sent ? 0 : count;
    note_write(recorder, ale_recording_write(&recorder->recording, sent ? ALE_CHUNK_SENT : ALE_CHUNK_RECEIVED,
                                             host_us, bytes, count));
}

/* Odometry comes in the time of messages; the recording has one clock, that of the bytes. */
static void on_odometry(void *user, const ale_odometry_t *sample)
{
    recorder_t *recorder = user;
    ale_odometry_t inside = *sample;
    inside.stamp_us = ale_clock_from_utime(&recorder->clock, sample->stamp_us);
    recorder->odometry++;
    note_write(recorder,
               ale_recording_odometry(&recorder->recording, ale_clock_now_us(&recorder->clock), &inside));
}

static int open_bus(recorder_t *recorder)
{
    if (recorder->options.no_lcm) {
        return 0;
    }
    char error[ALE_BUS_ERROR];
    recorder->bus = ale_bus_open(recorder->options.lcm_url, error);
    if (recorder->bus == NULL) {
        fprintf(stderr, "ale-record: %s (--no-lcm records without odometry)\n", error);
        return -1;
    }
    return ale_bus_on_odometry(recorder->bus, on_odometry, recorder);
}

static int open_all(recorder_t *recorder)
{
    const record_options_t *options = &recorder->options;
    recorder->clock = ale_clock_start(options->time_scale_ppm);
    if (open_bus(recorder) < 0) {
        return -1;
    }
    if (ale_recording_create(&recorder->recording, options->out) < 0) {
        fprintf(stderr, "ale-record: %s: %s\n", options->out, strerror(errno));
        return -1;
    }
    const ale_urg_config_t config = {
        .path = options->port,
        .serial = options->serial,
        .baud = options->baud,
        .step_ms = STEP_MS,
        .time_scale = (double)options->time_scale_ppm / ALE_CLOCK_REAL,
        .tap = on_bytes,
        .tap_user = recorder,
        .now_us = clock_now,
        .now_user = &recorder->clock,
    };
    recorder->urg = ale_urg_create(&config);
    return recorder->urg != NULL ? 0 : -1;
}

/* What the driver says, when it is news; numbers once a second where somebody watches. */
static void tell(recorder_t *recorder)
{
    const ale_urg_health_t *health = ale_urg_health(recorder->urg);
    const int64_t now_us = real_now_us();
    const bool watched = isatty(STDERR_FILENO) != 0;
    if (strcmp(recorder->status, health->status) != 0) {
        memcpy(recorder->status, health->status, sizeof recorder->status);
        fprintf(stderr, "%sale-record: %s\n", watched ? "\r\033[K" : "", health->status);
    }
    if (now_us - recorder->told_us >= SECOND_US) {
        recorder->told_us = now_us;
        note_write(recorder, fflush(recorder->recording.file));
        if (watched) {
            fprintf(stderr,
                    "\r\033[K%" PRId64 " s  %" PRIu64 " scans  %" PRIu64 " lost  %" PRIu64 " odometry",
                    (now_us - recorder->begin_us) / SECOND_US, health->scans, health->scans_lost,
                    recorder->odometry);
        }
    }
}

static bool over(const recorder_t *recorder)
{
    const int64_t limit_us = recorder->options.seconds * SECOND_US;
    return stop != 0 || recorder->write_error != 0 ||
           (limit_us > 0 && real_now_us() - recorder->begin_us >= limit_us);
}

static void record(recorder_t *recorder)
{
    static ale_scan_t scan;
    recorder->begin_us = real_now_us();
    while (!over(recorder)) {
        ale_urg_step(recorder->urg, &scan);
        if (recorder->bus != NULL) {
            ale_bus_receive(recorder->bus, 0);
        }
        tell(recorder);
    }
    if (isatty(STDERR_FILENO) != 0) {
        fputc('\n', stderr);
    }
}

/* Closes everything; the exit code. */
static int finish(recorder_t *recorder)
{
    const ale_urg_health_t health = *ale_urg_health(recorder->urg);
    ale_urg_destroy(recorder->urg);
    note_write(recorder, ale_recording_close(&recorder->recording));
    if (recorder->write_error != 0) {
        fprintf(stderr, "ale-record: %s: %s\n", recorder->options.out, strerror(recorder->write_error));
        return EXIT_FAILURE;
    }
    printf("scans %" PRIu64 "\nlost %" PRIu64 "\nbytes %" PRIu64 "\nodometry %" PRIu64 "\n", health.scans,
           health.scans_lost, recorder->bytes_in, recorder->odometry);
    if (health.scans == 0) {
        fprintf(stderr, "ale-record: no scan came: %s\n", health.status);
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    static recorder_t recorder;
    const int answered = record_parse_options(argc, argv, &recorder.options);
    if (answered != RECORD_GO_ON) {
        return answered;
    }
    catch_signals();
    int result = EXIT_FAILURE;
    if (open_all(&recorder) == 0) {
        record(&recorder);
        result = finish(&recorder);
    }
    ale_bus_close(recorder.bus);
    return result;
}
