/* The estimate task makes a system call. */
#include <unistd.h>

static void ale_planted(void)
{
    getppid();
}

#include "planted/into_estimate.h"
