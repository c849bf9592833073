/* The estimate task calls a function that comes back to itself by way of another. */
__attribute__((noinline)) static int odd(int n);

__attribute__((noinline)) static int even(int n)
{
    return n == 0 || !odd(n - 1) + (n >> 8);
}

__attribute__((noinline)) static int odd(int n)
{
    return n != 0 && !even(n - 1) + (n >> 8);
}

static void ale_planted(void)
{
    static volatile int depth = 3;
    depth = even(depth);
}

#include "planted/into_estimate.h"
