/* Runs of any points and fits to be joined; what any noise may hide from a line through points of any spread.
 *
 * proves: lib/extract/merge.c
 * with: lib/extract/segment.c lib/base/fixed.c
 * kernel: -no-warn-invalid-bool
 * options: -warn-invalid-bool -eva-plevel 1100 -eva-slevel 20 */
#include "unknown.h"
#include "unknown_runs.h"

#include "extract/merge.h"

static ale_run_list_t list;

void main(void)
{
    unknown_run_list(&list);
    ale_merge_runs(&list);
    const ale_spread_t spread = {.fit = unknown_fit(1), .along2_q8 = unknown(0, INT64_C(1) << 51)};
    ale_merge_doubt(&list.scan.noise, &spread);
}
