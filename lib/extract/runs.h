/* The runs of a scan: searched, split, their ends placed. */
#ifndef ALE_EXTRACT_RUNS_H
#define ALE_EXTRACT_RUNS_H

#include "extract/workspace.h"

/* Cuts every segment into runs by the binary search of ALE. O(lines log points) fits. */
void ale_runs_search(ale_extractor_t *e);

/* Drops the runs of fewer points, and where `enough` longer ones are there all that are shorter than those,
 * too, or as long and farther from the middle of the points: one more than enough are kept at most, where two
 * lie alike on either side of it. Dropped ones are counted as refused. O(runs log beams). */
void ale_runs_drop_short(ale_extractor_t *e, int32_t fewest, int32_t enough);

/* The points have moved: their runs are to be fitted anew. */
void ale_runs_forget_fits(ale_extractor_t *e);

/* Splits the runs that two lines explain better than one, and that are not known to be whole; their parts
 * take in what few points are left to the end of the surface, as far as they lie on their lines. Whether
 * there was one. O(lines log points) fits. */
bool ale_runs_split(ale_extractor_t *e);

/* Splits long runs at a step that is too sharp for what neighbours share, though not large beside it: two
 * lines explain such a run little better than one. Whether there was one. O(points). */
bool ale_runs_split_at_steps(ale_extractor_t *e);

/* Places the breaks between neighbouring runs by the best joint fit, all from the same state, but for those
 * between runs that are settled. widest_step: see breakpoint.h. */
void ale_runs_place(ale_extractor_t *e, int32_t widest_step);

/* The same once more, when most breaks of a room have settled: with as wide a step as there is effort left
 * for. False where there is none for any, then nothing is done. */
bool ale_runs_place_again(ale_extractor_t *e, int32_t widest_step);

/* Gives up the outer points of a run that the rest of it does not explain: where a surface ends a beam may
 * meet two. At most six fits. */
void ale_run_trim(const ale_extractor_t *e, ale_run_t *run);

#endif
