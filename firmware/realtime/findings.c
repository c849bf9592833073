#include "realtime/findings.h"

#include <stdio.h>
#include <string.h>

static void append(char *list, size_t size, const char *format, int number)
{
    const size_t used = strlen(list);
    const size_t comma = used ? 2 : 0;
    if (used + comma < size) {
        memcpy(list + used, ", ", comma);
        snprintf(list + used + comma, size - used - comma, format, number);
    }
}

void ale_rt_found(ale_rt_findings_t *findings, bool there, const char *format, int number)
{
    if (there) {
        append(findings->got, sizeof findings->got, format, number);
    } else {
        append(findings->missing, sizeof findings->missing, format, number);
    }
}

void ale_rt_findings_report(const ale_rt_findings_t *findings, ale_rt_report_t *report)
{
    const char *missing = findings->missing;
    report->realtime = missing[0] == '\0';
    snprintf(report->text, sizeof report->text, "%s%s%s", findings->got, missing[0] ? "; missing: " : "",
             missing);
}
