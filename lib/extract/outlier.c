#include "extract/outlier.h"

enum { STRAY_BEAMS = 2 };

static void move_point(ale_extractor_t *e, int32_t to, int32_t from)
{
    e->beam[to] = e->beam[from];
    e->range_um[to] = e->range_um[from];
    e->inverse_q44[to] = e->inverse_q44[from];
}

void ale_outlier_remove(ale_extractor_t *e)
{
    int32_t kept = 0;
    int32_t first = 0;
    for (int32_t i = 0; i < e->count; i++) {
        if (!e->jump_after[i]) {
            continue;
        }
        for (int32_t k = first; i - first >= STRAY_BEAMS && k <= i; k++) {
            move_point(e, kept++, k);
        }
        first = i + 1;
    }
    e->outliers = (uint16_t)(e->count - kept);
    e->count = (uint16_t)kept;
}
