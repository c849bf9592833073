#include "realtime/findings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void append(char *list, size_t size, const char *format, va_list arguments)
{
    const size_t used = strlen(list);
    const size_t comma = used ? 2 : 0;
    if (used + comma < size) {
        memcpy(list + used, ", ", comma);
        vsnprintf(list + used + comma, size - used - comma, format, arguments);
    }
}

void ale_rt_found(ale_rt_findings_t *findings, bool there, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    append(there ? findings->got : findings->missing, sizeof findings->got, format, arguments);
    va_end(arguments);
}

void ale_rt_findings_report(const ale_rt_findings_t *findings, ale_rt_report_t *report)
{
    _Static_assert(sizeof findings->got == sizeof findings->missing, "both are filled by the same function");
    const char *missing = findings->missing;
    report->realtime = missing[0] == '\0';
    snprintf(report->text, sizeof report->text, "%s%s%s", findings->got, missing[0] ? "; missing: " : "",
             missing);
}
