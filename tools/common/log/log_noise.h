/* How rough the ranges of a log are, as far as it says what scanner took them. */
#ifndef ALE_COMMON_LOG_LOG_NOISE_H
#define ALE_COMMON_LOG_LOG_NOISE_H

extern "C" {
#include "base/noise.h"
#include "log/log_event.h"
}

namespace ale
{

/* By the preset of the scanner that the log names; else the default for a URG-04LX, and that of large
 * scanners. */
ale_noise_t noise_of_log(const ale_log_info_t &info);

} // namespace ale

#endif
