/* Whether the scanner stood still while it was recorded.
 *
 * The noise of each beam is taken from the differences of successive scans, which motion hardly touches.
 * Medians over blocks of scans then differ by noise alone where the scanner stands. With u the direction of a
 * beam, w the one a quarter turn to its left and r' = dr/dphi, a scanner that has moved by t and turned by
 * theta sees dr = (r' / r w - u) . t + r' theta, which gives t and theta of each block by least squares over
 * all beams, with people who walk past weighed down. */
#ifndef ALE_ROBOT_CALIBRATE_REST_H
#define ALE_ROBOT_CALIBRATE_REST_H

#include <vector>

#include "robot/calibrate/temporal.h"

namespace calibrate
{

/* Throws std::runtime_error that says by how much and when the scanner moved: where its motion changes the
 * ranges by more than half of their noise, or a fifth of the beams measure other ranges than at the start. */
void require_rest(const Recording &recording, const std::vector<Beam> &beams);

} // namespace calibrate

#endif
