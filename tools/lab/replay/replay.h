/* A log through the firmware's code: every event in the order of the log, results into the files asked for.
 */
#ifndef ALE_LAB_REPLAY_REPLAY_H
#define ALE_LAB_REPLAY_REPLAY_H

#include "lab/replay/options.h"

namespace ale
{

/* Throws std::runtime_error (log or file trouble; no scan in the log) or cli::WrongUse (bad
 * configuration), each with one line for people. */
void replay(const ReplayOptions &options);

} // namespace ale

#endif
