#include "common/export/formatted.h"

#include <cstdarg>
#include <cstdio>

namespace ale
{

std::string formatted(const char *pattern, ...)
{
    char text[256];
    va_list values;
    va_start(values, pattern);
    /* NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): it was started one line above. */
    vsnprintf(text, sizeof text, pattern, values);
    va_end(values);
    return text;
}

} // namespace ale
