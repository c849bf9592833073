/* A recording of a scanner's bytes (.scip), as the robot would have sent it over LCM: by ale-replay, in a
 * process of its own.
 *
 *   const Replay replay = replayed(shelf.open(name), name, stopping);
 *
 * The log is a file without a name in the folder for temporary files: it is gone with its descriptor. Other
 * programs of this machine come first, and of that disk 32 MB are left. */
#ifndef CONSOLE_REPLAYED_H
#define CONSOLE_REPLAYED_H

#include <atomic>
#include <string>

#include "operator/console/recordings/descriptor.h"

namespace console
{

struct Replay {
    Descriptor log;
    std::string damage; /* what of the recording was left out, in words; empty: nothing */
};

/* name: what the recording is called. Blocks for as long as it takes, seconds mostly, or until `stopping`.
 * Throws std::runtime_error in words for people: no scan in it, no room, no ale-replay. */
Replay replayed(const Descriptor &recording, const std::string &name, const std::atomic<bool> &stopping);

} // namespace console

#endif
