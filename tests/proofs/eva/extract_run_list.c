/* Runs of any points, kept by their length and place; limits of any number of points.
 *
 * proves: lib/extract/run_list.c
 * with: lib/base/fixed.c
 * options: -eva-plevel 1100 -eva-auto-loop-unroll 217 -eva-slevel 20 */
#include "unknown.h"
#include "unknown_runs.h"

static ale_run_list_t list;

void main(void)
{
    ale_run_list_init(&list, (uint16_t)unknown(ALE_MIN_RUN, ALE_MAX_BEAMS));
    unknown_run_list(&list);
    ale_run_list_forget_fits(&list);
    unknown_run_list(&list);
    ale_run_list_drop_short(&list, (int32_t)unknown(1, 4 * ALE_MAX_BEAMS / 3), ALE_MANY_RUNS);
}
