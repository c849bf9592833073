/* The latencies as text for people: a table of quantiles, and one histogram of all spans. */
#ifndef LATENCY_REPORT_H
#define LATENCY_REPORT_H

#include <string>

#include "robot/latency/latencies.h"

namespace latency
{

std::string report(const Latencies &latencies);

} // namespace latency

#endif
