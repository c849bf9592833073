/* A file of lib with a function that calls itself. */
#include <stdint.h>

uint32_t ale_planted(uint32_t n);

uint32_t ale_planted(uint32_t n)
{
    volatile uint32_t here = n;
    return n < 2 ? here : ale_planted(n - 1) + ale_planted(n - 2) + here;
}
