/* The estimate task allocates: more than the heap has at hand, so that it also shows as a system call. */
#include <stdlib.h>

static void ale_planted(void)
{
    void *volatile memory = malloc(64 << 20);
    free(memory);
}

#include "planted/into_estimate.h"
