/* The estimate task calls what an address says that nobody has vouched for. */
#include <stddef.h>

static void ale_planted(void)
{
    static void (*volatile somewhere)(void) = NULL;
    if (somewhere) {
        somewhere();
    }
}

#include "planted/into_estimate.h"
