#include "system/log_line.h"

#include <stdarg.h>
#include <stdlib.h>

enum { MOST_BYTES = 1000 };

bool ale_log_wants_time(void)
{
    return getenv("JOURNAL_STREAM") == NULL;
}

void ale_log_write(FILE *out, bool with_time, time_t logged_s, const char *words)
{
    char moment[32] = "";
    struct tm local;
    if (with_time && localtime_r(&logged_s, &local)) {
        strftime(moment, sizeof moment, "%Y-%m-%d %H:%M:%S ", &local);
    }
    fprintf(out, "ale-slamd: %s%s\n", moment, words);
    fflush(out);
}

void ale_log_line(const char *format, ...)
{
    char words[MOST_BYTES + 1];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    ale_log_write(stderr, ale_log_wants_time(), time(NULL), words);
}
