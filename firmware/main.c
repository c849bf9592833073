/* ale-slamd: reads a laser scanner, publishes pose, features and map. Wiring only. */
#include <signal.h>
#include <stdlib.h>

#include "daemon.h"
#include "options.h"

/* Blocked everywhere, so that no thread is interrupted; main waits for the two that end the program. */
static void wait_for_end(const sigset_t *ends)
{
    int received = 0;
    sigwait(ends, &received);
}

int main(int count, char **arguments)
{
    static ale_options_t options;
    const ale_options_result_t result = ale_options_read(count, arguments, &options, stdout);
    if (result != ALE_OPTIONS_RUN) {
        return result == ALE_OPTIONS_DONE ? EXIT_SUCCESS : 2;
    }
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGTERM);
    sigaddset(&ends, SIGINT);
    sigprocmask(SIG_BLOCK, &ends, NULL);
    signal(SIGPIPE, SIG_IGN);
    int exit_code = 0;
    ale_daemon_t *daemon = ale_daemon_start(&options, &exit_code);
    if (!daemon) {
        return exit_code;
    }
    wait_for_end(&ends);
    ale_daemon_stop(daemon);
    return EXIT_SUCCESS;
}
