/* A file of lib that allocates. */
#include <stdint.h>
#include <stdlib.h>

int32_t *ale_planted(uint32_t count);

int32_t *ale_planted(uint32_t count)
{
    return calloc(count, sizeof(int32_t));
}
