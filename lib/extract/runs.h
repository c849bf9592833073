/* The runs of a scan: searched, split, their ends placed. */
#ifndef ALE_EXTRACT_RUNS_H
#define ALE_EXTRACT_RUNS_H

#include "extract/run_list.h"

/* Cuts every segment into runs by the binary search of ALE. O(lines log points) fits. */
void ale_runs_search(ale_run_list_t *r);

/* Splits the runs that two lines explain better than one, and that are not known to be whole; their parts
 * take in what few points are left to the end of the surface, as far as they lie on their lines. Whether
 * there was one. O(lines log points) fits. */
bool ale_runs_split(ale_run_list_t *r);

/* Splits long runs at a step that is too sharp for what neighbours share, though not large beside it: two
 * lines explain such a run little better than one. Whether there was one. O(points). */
bool ale_runs_split_at_steps(ale_run_list_t *r);

/* Places the breaks between neighbouring runs by the best joint fit, all from the same state, but for those
 * between runs that are settled. widest_step: see breakpoint.h. */
void ale_runs_place(ale_run_list_t *r, int32_t widest_step);

/* The same once more, when most breaks of a room have settled: with as wide a step as there is effort left
 * for. False where there is none for any, then nothing is done. */
bool ale_runs_place_again(ale_run_list_t *r, int32_t widest_step);

/* Gives up the outer points of a run that the rest of it does not explain: where a surface ends a beam may
 * meet two. At most six fits. */
void ale_run_trim(const ale_run_list_t *r, ale_run_t *run);

#endif
