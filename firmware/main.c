/* ale-slamd: reads a laser scanner, publishes pose, features and map. Wiring only. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/options.h"
#include "daemon.h"

/* Blocked everywhere, so that no thread is interrupted; main waits for the two that end the program, and for
 * the one that asks for a flight recording. */
static void wait_for_end(const sigset_t *signals, ale_daemon_t *daemon)
{
    int received = 0;
    while (sigwait(signals, &received) == 0 && received == SIGUSR1) {
        ale_daemon_record(daemon);
    }
}

/* After --help and the like: whether it was said. */
static int end_of_words(void)
{
    errno = EIO;
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "ale-slamd: standard output: %s\n", strerror(errno));
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

int main(int count, char **arguments)
{
    static ale_options_t options;
    const ale_options_result_t result = ale_options_read(count, arguments, &options, stdout);
    if (result != ALE_OPTIONS_RUN) {
        return result == ALE_OPTIONS_DONE ? end_of_words() : 2;
    }
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGUSR1);
    sigprocmask(SIG_BLOCK, &signals, NULL);
    signal(SIGPIPE, SIG_IGN);
    int exit_code = 0;
    ale_daemon_t *daemon = ale_daemon_start(&options, &exit_code);
    if (!daemon) {
        return exit_code;
    }
    wait_for_end(&signals, daemon);
    ale_daemon_stop(daemon);
    return EXIT_SUCCESS;
}
