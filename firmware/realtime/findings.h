/* What was got and what is missing, gathered for the report of a back end. */
#ifndef ALE_FIRMWARE_REALTIME_FINDINGS_H
#define ALE_FIRMWARE_REALTIME_FINDINGS_H

#include <stdbool.h>

#include "realtime/rt.h"

typedef struct {
    char got[200];
    char missing[200];
} ale_rt_findings_t; /* begins zeroed */

/* Adds one finding to the list of what is there, or to that of what is missing. What does not fit is cut. */
void ale_rt_found(ale_rt_findings_t *findings, bool there, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "got, got; missing: this, that"; real time when nothing is missing. */
void ale_rt_findings_report(const ale_rt_findings_t *findings, ale_rt_report_t *report);

#endif
