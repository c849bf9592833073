#include "realtime/machine.h"

#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

enum { WORD_BYTES = 40, PATH_BYTES = 256, FINE_ENOUGH_NS = 1000 };

/* The first word of a file; false when there is no such file. */
static bool read_word(const char *path, char word[WORD_BYTES])
{
    FILE *file = fopen(path, "re");
    const bool found = file && fscanf(file, "%39s", word) == 1;
    if (file) {
        fclose(file);
    }
    return found;
}

void ale_rt_check_kernel(ale_rt_findings_t *findings, const char *root)
{
    char path[PATH_BYTES];
    char word[WORD_BYTES] = "";
    struct utsname system;
    snprintf(path, sizeof path, "%s/sys/kernel/realtime", root);
    const bool preempt_rt = read_word(path, word) && strcmp(word, "1") == 0;
    const char *release = uname(&system) == 0 ? system.release : "?";
    if (preempt_rt) {
        ale_rt_found(findings, true, "PREEMPT_RT kernel %.32s", release);
    } else {
        ale_rt_found(findings, false, "PREEMPT_RT kernel (this is %.32s)", release);
    }
}

void ale_rt_check_timer(ale_rt_findings_t *findings)
{
    struct timespec step = {.tv_sec = 1};
    clock_getres(CLOCK_MONOTONIC, &step);
    const bool fine = step.tv_sec == 0 && step.tv_nsec <= FINE_ENOUGH_NS;
    ale_rt_found(findings, fine, fine ? "timer to %ld ns" : "high-resolution timer (steps of %ld ns)",
                 step.tv_nsec);
}

/* The governor of one processor; false when nothing scales its frequency. */
static bool read_governor(int cpu, const char *root, char word[WORD_BYTES])
{
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/sys/devices/system/cpu/cpu%d/cpufreq/scaling_governor", root, cpu);
    return read_word(path, word);
}

void ale_rt_check_governor(ale_rt_findings_t *findings, int32_t cpu, const char *root)
{
    const int first = cpu < 0 ? 0 : cpu;
    const int last = cpu < 0 ? (int)sysconf(_SC_NPROCESSORS_CONF) - 1 : cpu;
    bool scaled = false;
    for (int k = first; k <= last; k++) {
        char word[WORD_BYTES] = "";
        const bool found = read_governor(k, root, word);
        if (found && strcmp(word, "performance") != 0) {
            ale_rt_found(findings, false, "governor performance (processor %d has %.16s)", k, word);
            return;
        }
        scaled = scaled || found;
    }
    ale_rt_found(findings, true, "%s", scaled ? "governor performance" : "constant frequency");
}
