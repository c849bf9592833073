/* What a recording is, without reading all of it: when it was made, and the last map in it. */
#ifndef CONSOLE_RECORDING_SUMMARY_H
#define CONSOLE_RECORDING_SUMMARY_H

#include <cstdint>
#include <memory>

#include "operator/console/recordings/descriptor.h"

extern "C" {
#include "track/pipeline.h"
}

namespace console
{

struct RecordingSummary {
    int64_t from_us = 0; /* when the first event was received, and the last one; both 0: there is none */
    int64_t to_us = 0;
    bool has_scans = false;               /* ale-replay wants them */
    std::shared_ptr<const ale_map_t> map; /* nullptr: none that is whole near the end */
};

/* Throws std::runtime_error with the system's words. Reads 16 MiB at most, many seconds of a robot; the robot
 * sends its map whole every ten. */
RecordingSummary summary_of(const Descriptor &file);

} // namespace console

#endif
