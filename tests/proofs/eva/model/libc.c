/* What the C library does, as far as the proofs need to know: any answer that its standard allows. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "unknown.h"

/* Any number, and an end anywhere in the text. */
long strtol(const char *text, char **end, int base)
{
    (void)base;
    const size_t length = strlen(text);
    if (end) {
        *end = (char *)text + unknown_unsigned(0, length);
    }
    return unknown(LONG_MIN, LONG_MAX);
}

long long strtoll(const char *text, char **end, int base)
{
    return strtol(text, end, base);
}

/* Nowhere, or anywhere within. */
void *memmem(const void *in, size_t in_bytes, const void *of, size_t of_bytes)
{
    (void)of;
    (void)of_bytes;
    return in_bytes == 0 || unknown(0, 1) ? NULL : (char *)in + unknown_unsigned(0, in_bytes - 1);
}
