/* Lines, words and numbers of a text held in memory. Nothing is copied or changed; pure functions.
 *
 *   ale_text_t text = ale_text(bytes, count);   ale_span_t line, word;
 *   while (ale_text_line(&text, &line)) while (ale_text_word(&line, &word)) ...
 *
 * Numbers become integers of a stated unit by decimal arithmetic alone: the same on every machine. */
#ifndef ALE_FILE_TEXT_H
#define ALE_FILE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    const char *at;
    const char *end;
} ale_span_t;

typedef struct {
    const char *at;
    const char *end;
    uint64_t line; /* number of the line last taken, from 1 */
} ale_text_t;

ale_text_t ale_text(const void *bytes, size_t count);

/* The next line, without its line feed; the last one may have none. False at the end. */
bool ale_text_line(ale_text_t *text, ale_span_t *line);

/* Takes the next word (blank, tab and carriage return separate) off the front of *line. False: none left. */
bool ale_text_word(ale_span_t *line, ale_span_t *word);

/* Number of words, counted up to `most`. */
uint32_t ale_text_count_words(ale_span_t line, uint32_t most);

/* The word is exactly this. */
bool ale_text_is(ale_span_t word, const char *what);

/* The word as a number times 10^decimals (0..18), rounded half away from zero: sign, digits, point and
 * exponent. False, and *out untouched: not a number, or beyond int64. */
bool ale_text_decimal(ale_span_t word, unsigned decimals, int64_t *out);

/* The same for a value that must fit int32; false also when it does not. */
bool ale_text_decimal32(ale_span_t word, unsigned decimals, int32_t *out);

/* The words of a line as `count` numbers, and no more. False: others, and *numbers then holds anything. */
bool ale_text_numbers(ale_span_t line, int64_t *numbers, uint32_t count);

/* Radians to BAM, any number of turns up to 10^8 rad. False, and *angle_bam untouched: no number, or beyond.
 */
bool ale_text_angle(ale_span_t word, uint32_t *angle_bam);

#endif
