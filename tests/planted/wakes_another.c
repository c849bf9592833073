/* The estimate task wakes a thread: by the call it is allowed, in a form it is not. */
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

static void ale_planted(void)
{
    static int word;
    syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, 0, 0, 0);
}

#include "planted/into_estimate.h"
