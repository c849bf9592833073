/* The seam of a whole turn: the last beam is next to the first, and a wall may lie across.
 *
 * The points of such a scan are ordered from where a surface most likely ends, wherever the scanner begins,
 * so that a turned or mirrored scan gives the turned or mirrored features. Where no surface ends there after
 * all the order is turned once more, to a break that was found, and what meets at the old seam is judged like
 * any other runs. Scans with two ends are left as they are. */
#ifndef ALE_EXTRACT_SEAM_H
#define ALE_EXTRACT_SEAM_H

#include "extract/run_list.h"

/* Orders the listed points of a turn (points.turn_beams > 0) from behind the widest gap, or the sharpest
 * change of the range that those beside it do not share. The sums are overwritten. O(points). */
void ale_seam_open(ale_prepared_scan_t *scan);

/* Joins what meets at the seam, if no surface ends there: the runs beside it are merged or their break placed
 * as all others were. O(points), and what merging and placing breaks takes. */
void ale_seam_close(ale_run_list_t *list);

#endif
