/* Which format a log has, by its content. Internal to drivers/log. */
#ifndef ALE_LOG_DETECT_H
#define ALE_LOG_DETECT_H

#include "log/format.h"

/* The format of log->bytes. A text format is told by its first line that a format claims. NULL and *reason in
 * plain words: empty, binary and of no known kind, or no line of a known format. */
const ale_log_format_t *ale_log_detect(ale_log_t *log, const char **reason);

#endif
