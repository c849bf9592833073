#include "config/decimal.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/fixed.h"

#define LARGEST_NUMBER 1000000000

static int64_t power_of_ten(unsigned exponent)
{
    int64_t power = 1;
    for (unsigned k = 0; k < exponent; k++) {
        power *= 10;
    }
    return power;
}

/* Digits before the point: advances *text; -1 when there are too many. */
static int64_t parse_whole(const char **text)
{
    int64_t whole = 0;
    for (; **text >= '0' && **text <= '9'; (*text)++) {
        whole = whole * 10 + (**text - '0');
        if (whole > LARGEST_NUMBER) {
            return -1;
        }
    }
    return whole;
}

/* Digits after the point, `digits` of them kept, the next one rounds. */
static int64_t parse_fraction(const char **text, unsigned digits)
{
    int64_t fraction = 0;
    unsigned seen = 0;
    bool up = false;
    for (; **text >= '0' && **text <= '9'; (*text)++, seen++) {
        if (seen < digits) {
            fraction = fraction * 10 + (**text - '0');
        } else if (seen == digits) {
            up = **text >= '5';
        }
    }
    const unsigned missing = seen < digits ? digits - seen : 0;
    return fraction * power_of_ten(missing) + (up ? 1 : 0);
}

int ale_decimal_parse(const char *text, unsigned digits, int64_t *out)
{
    const bool negative = *text == '-';
    text += *text == '-' || *text == '+';
    const char *start = text;
    const int64_t whole = parse_whole(&text);
    bool any = text != start;
    int64_t fraction = 0;
    if (*text == '.') {
        start = ++text;
        fraction = parse_fraction(&text, digits);
        any = any || text != start;
    }
    if (!any || *text != '\0' || whole < 0) {
        return -1;
    }
    const int64_t value = whole * power_of_ten(digits) + fraction;
    *out = negative ? -value : value;
    return 0;
}

void ale_decimal_print(int64_t value, unsigned digits, char out[ALE_DECIMAL_TEXT])
{
    const int64_t scale = power_of_ten(digits);
    const int64_t size = ale_abs64(value);
    const char *sign = value < 0 ? "-" : "";
    int length = snprintf(out, ALE_DECIMAL_TEXT, "%s%" PRId64, sign, size / scale);
    if (digits == 0 || size % scale == 0) {
        return;
    }
    snprintf(out + length, (size_t)(ALE_DECIMAL_TEXT - length), ".%0*" PRId64, (int)digits, size % scale);
    for (size_t last = strlen(out) - 1; out[last] == '0'; last--) {
        out[last] = '\0';
    }
}

int64_t ale_decimal_round(int64_t value, unsigned digits, unsigned kept)
{
    const int64_t step = power_of_ten(digits - kept);
    return ale_round_div(value, step) * step;
}
