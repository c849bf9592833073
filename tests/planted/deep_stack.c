/* The estimate task keeps a buffer on its stack. */
__attribute__((noinline)) static void ale_planted(void)
{
    volatile char buffer[20000];
    buffer[sizeof buffer - 1] = 0;
}

#include "planted/into_estimate.h"
