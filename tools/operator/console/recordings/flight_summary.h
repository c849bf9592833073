/* What a recording of a scanner's bytes (.scip) is, without replaying it: when it was made, how long it is,
 * and why the flight recorder wrote it. */
#ifndef CONSOLE_FLIGHT_SUMMARY_H
#define CONSOLE_FLIGHT_SUMMARY_H

#include <cstdint>
#include <string>

#include "operator/console/recordings/descriptor.h"

namespace console
{

struct FlightSummary {
    int64_t from_us =
        0; /* of the bytes, by the robot's clock, which may know no date; both 0: there are none */
    int64_t to_us = 0;
    int64_t written_ms = 0; /* since 1970; 0: its name does not tell */
    std::string reason;     /* "fault", "deadline", "command"; empty: its name does not tell */
};

/* By its beginning and its end, 256 KiB each, and by its name (firmware/recorder/flight_file.h). */
FlightSummary summary_of_flight(const Descriptor &file, const std::string &name);

} // namespace console

#endif
