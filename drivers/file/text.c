#include "file/text.h"

#include <string.h>

#include "base/fixed.h"

/* 2^32 / (2 pi 10^9) * 2^62: nanoradians to BAM for any number of turns. */
static const int64_t BAM_PER_NRAD_Q62 = 3152388424058293983;
static const int64_t MOST_NRAD = 100000000000000000;
enum { MOST_DIGITS = 18, MOST_EXPONENT = 400 };

typedef struct {
    bool negative;
    uint64_t digits; /* up to MOST_DIGITS of them */
    int32_t scale;   /* value = digits * 10^scale */
} decimal_t;

ale_text_t ale_text(const void *bytes, size_t count)
{
    const char *at = bytes;
    return (ale_text_t){.at = at, .end = at + count, .line = 0};
}

bool ale_text_line(ale_text_t *text, ale_span_t *line)
{
    if (text->at >= text->end) {
        return false;
    }
    const char *feed = memchr(text->at, '\n', (size_t)(text->end - text->at));
    line->at = text->at;
    line->end = feed ? feed : text->end;
    text->at = feed ? feed + 1 : text->end;
    text->line++;
    return true;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

bool ale_text_word(ale_span_t *line, ale_span_t *word)
{
    while (line->at < line->end && is_blank(*line->at)) {
        line->at++;
    }
    word->at = line->at;
    while (line->at < line->end && !is_blank(*line->at)) {
        line->at++;
    }
    word->end = line->at;
    return word->at < word->end;
}

uint32_t ale_text_count_words(ale_span_t line, uint32_t most)
{
    ale_span_t word;
    uint32_t count = 0;
    while (count < most && ale_text_word(&line, &word)) {
        count++;
    }
    return count;
}

bool ale_text_is(ale_span_t word, const char *what)
{
    const size_t length = strlen(what);
    return (size_t)(word.end - word.at) == length && memcmp(word.at, what, length) == 0;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool take_sign(ale_span_t *word)
{
    const bool negative = word->at < word->end && *word->at == '-';
    if (negative || (word->at < word->end && *word->at == '+')) {
        word->at++;
    }
    return negative;
}

/* Digits and point. What exceeds MOST_DIGITS only shifts the scale. */
static bool take_digits(ale_span_t *word, decimal_t *out)
{
    uint32_t seen = 0;
    uint32_t kept = 0;
    bool fraction = false;
    for (; word->at < word->end && (is_digit(*word->at) || (*word->at == '.' && !fraction)); word->at++) {
        if (*word->at == '.') {
            fraction = true;
            continue;
        }
        seen++;
        if (kept < MOST_DIGITS) {
            out->digits = out->digits * 10 + (uint64_t)(*word->at - '0');
            kept += out->digits > 0;
            out->scale -= fraction;
        } else {
            out->scale += !fraction;
        }
    }
    return seen > 0;
}

static bool take_exponent(ale_span_t *word, decimal_t *out)
{
    if (word->at == word->end) {
        return true;
    }
    if (*word->at != 'e' && *word->at != 'E') {
        return false;
    }
    word->at++;
    const bool negative = take_sign(word);
    int32_t exponent = 0;
    const char *first = word->at;
    for (; word->at < word->end && is_digit(*word->at); word->at++) {
        exponent = exponent < MOST_EXPONENT ? exponent * 10 + (*word->at - '0') : exponent;
    }
    out->scale += negative ? -exponent : exponent;
    return word->at > first && word->at == word->end;
}

static int64_t power_of_ten(int32_t exponent)
{
    int64_t power = 1;
    for (int32_t i = 0; i < exponent; i++) {
        power *= 10;
    }
    return power;
}

static bool scaled(uint64_t digits, int32_t scale, int64_t *out)
{
    if (digits == 0 || scale < -MOST_DIGITS) {
        *out = 0;
        return true;
    }
    if (scale <= 0) {
        *out = ale_round_div((int64_t)digits, power_of_ten(-scale));
        return true;
    }
    if (scale > MOST_DIGITS || (int64_t)digits > INT64_MAX / power_of_ten(scale)) {
        return false;
    }
    *out = (int64_t)digits * power_of_ten(scale);
    return true;
}

bool ale_text_decimal(ale_span_t word, unsigned decimals, int64_t *out)
{
    decimal_t number = {.negative = take_sign(&word), .scale = (int32_t)decimals};
    int64_t value = 0;
    if (!take_digits(&word, &number) || !take_exponent(&word, &number) ||
        !scaled(number.digits, number.scale, &value)) {
        return false;
    }
    *out = number.negative ? -value : value;
    return true;
}

bool ale_text_decimal32(ale_span_t word, unsigned decimals, int32_t *out)
{
    int64_t value = 0;
    if (!ale_text_decimal(word, decimals, &value) || value < INT32_MIN || value > INT32_MAX) {
        return false;
    }
    *out = (int32_t)value;
    return true;
}

bool ale_text_numbers(ale_span_t line, int64_t *numbers, uint32_t count)
{
    ale_span_t word;
    for (uint32_t i = 0; i < count; i++) {
        if (!ale_text_word(&line, &word) || !ale_text_decimal(word, 0, &numbers[i])) {
            return false;
        }
    }
    return !ale_text_word(&line, &word);
}

bool ale_text_angle(ale_span_t word, uint32_t *angle_bam)
{
    int64_t nrad = 0;
    if (!ale_text_decimal(word, 9, &nrad) || ale_abs64(nrad) > MOST_NRAD) {
        return false;
    }
    *angle_bam = (uint32_t)ale_mul_shift(nrad, BAM_PER_NRAD_Q62, 62);
    return true;
}
