/* A file of lib that computes with floating point on its way from integer to integer. */
#include <stdint.h>

int32_t ale_planted(int32_t um);

int32_t ale_planted(int32_t um)
{
    return (int32_t)((float)um * 0.7F);
}
