/* The estimate task keeps something on its stack whose size nobody knows beforehand. */
__attribute__((noinline)) static void ale_planted(void)
{
    static volatile int size = 100;
    volatile char buffer[size];
    buffer[size - 1] = 0;
}

#include "planted/into_estimate.h"
