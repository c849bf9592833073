#include "scanner/urg/stranger.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum {
    TEXT_LEAST = 8, /* printable characters before a line end, as noise hardly shows them */
    TEXT_SHOWN = 24,
    NOISE_SHOWN = 6,
    NODE_BYTES = 5,   /* of a measurement of an RPLIDAR */
    NODES_LEAST = 12, /* 4^-12: noise does not look so */
    DESCRIPTOR_BYTES = 7
};

void ale_stranger_hear(ale_stranger_t *s, const uint8_t *bytes, uint32_t count)
{
    const uint32_t newest = count < ALE_STRANGER_BYTES ? count : ALE_STRANGER_BYTES;
    const uint32_t room = ALE_STRANGER_BYTES - newest;
    const uint32_t stay = s->count < room ? s->count : room;
    memmove(s->bytes, s->bytes + s->count - stay, stay);
    memcpy(s->bytes + stay, bytes + count - newest, newest);
    s->count = stay + newest;
}

static bool is_printable(uint8_t byte)
{
    return byte >= 0x20 && byte < 0x7f;
}

static bool is_line_end(uint8_t byte)
{
    return byte == '\r' || byte == '\n';
}

/* Start of the longest run of printable characters, and how many those are. */
static uint32_t longest_text(const uint8_t *bytes, uint32_t count, uint32_t *start)
{
    uint32_t longest = 0;
    uint32_t run = 0;
    for (uint32_t i = 0; i < count; i++) {
        run = is_printable(bytes[i]) ? run + 1 : 0;
        if (run > longest) {
            longest = run;
            *start = i + 1 - run;
        }
    }
    return longest;
}

static bool is_text(const ale_stranger_t *s)
{
    uint32_t readable = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        readable += is_printable(s->bytes[i]) || is_line_end(s->bytes[i]) || s->bytes[i] == '\t';
    }
    uint32_t start = 0;
    return readable == s->count && longest_text(s->bytes, s->count, &start) >= TEXT_LEAST;
}

/* "$GPGGA,": talker and sentence are capital letters. */
static bool is_nmea(const ale_stranger_t *s)
{
    for (uint32_t i = 0; i + 7 <= s->count; i++) {
        uint32_t capitals = 0;
        while (capitals < 5 && s->bytes[i + 1 + capitals] >= 'A' && s->bytes[i + 1 + capitals] <= 'Z') {
            capitals++;
        }
        if ((s->bytes[i] == '$' || s->bytes[i] == '!') && capitals == 5 && s->bytes[i + 6] == ',') {
            return true;
        }
    }
    return false;
}

/* A5 5A, 30 bits of length (of which no answer needs more than 10), and the answer's type. */
static bool has_descriptor(const ale_stranger_t *s)
{
    for (uint32_t i = 0; i + DESCRIPTOR_BYTES <= s->count; i++) {
        const uint8_t *at = s->bytes + i;
        if (at[0] == 0xa5 && at[1] == 0x5a && at[3] < 4 && at[4] == 0 && (at[5] & 0x3f) == 0 && at[6] != 0) {
            return true;
        }
    }
    return false;
}

/* The lowest two bits of a measurement differ, and the lowest of its second byte is set. */
static bool has_nodes(const ale_stranger_t *s)
{
    for (uint32_t start = 0; start < NODE_BYTES; start++) {
        uint32_t nodes = 0;
        for (uint32_t i = start; i + NODE_BYTES <= s->count; i += NODE_BYTES) {
            const bool one = (s->bytes[i] & 1) != (s->bytes[i] >> 1 & 1) && (s->bytes[i + 1] & 1) == 1;
            nodes = one ? nodes + 1 : 0;
            if (nodes == NODES_LEAST) {
                return true;
            }
        }
    }
    return false;
}

static bool says_rplidar(const ale_stranger_t *s)
{
    static const char *const names[] = {"RP LIDAR", "RPLIDAR", "SLAMTEC"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        if (memmem(s->bytes, s->count, names[n], strlen(names[n])) != NULL) {
            return true;
        }
    }
    return false;
}

static ale_stranger_kind_t kind_of(const ale_stranger_t *s)
{
    if (s->count == 0) {
        return ALE_STRANGER_SILENT;
    }
    if (says_rplidar(s)) {
        return ALE_STRANGER_RPLIDAR;
    }
    if (is_nmea(s)) {
        return ALE_STRANGER_NMEA;
    }
    if (is_text(s)) {
        return ALE_STRANGER_TEXT;
    }
    return has_descriptor(s) || has_nodes(s) ? ALE_STRANGER_RPLIDAR : ALE_STRANGER_NOISE;
}

void ale_stranger_judge(ale_stranger_t *s)
{
    const ale_stranger_kind_t kind = kind_of(s);
    if (kind > s->kind) {
        s->kind = kind;
        memcpy(s->told, s->bytes, s->count);
        s->told_count = s->count;
    }
    s->count = 0;
}

/* The longest readable piece, for people to recognise. */
static void quote(const ale_stranger_t *s, const char *before, char words[ALE_STRANGER_WORDS])
{
    uint32_t start = 0;
    const uint32_t count = longest_text(s->told, s->told_count, &start);
    snprintf(words, ALE_STRANGER_WORDS, "%s: %.*s", before, (int)(count < TEXT_SHOWN ? count : TEXT_SHOWN),
             (const char *)s->told + start);
}

static void list_bytes(const ale_stranger_t *s, char words[ALE_STRANGER_WORDS])
{
    int used = snprintf(words, ALE_STRANGER_WORDS, "bytes come that are nothing known, or of another rate:");
    for (uint32_t i = 0; i < s->told_count && i < NOISE_SHOWN; i++) {
        used += snprintf(words + used, ALE_STRANGER_WORDS - (size_t)used, " %02x", s->told[i]);
    }
}

void ale_stranger_words(const ale_stranger_t *s, char words[ALE_STRANGER_WORDS])
{
    switch (s->kind) {
    case ALE_STRANGER_SILENT:
        snprintf(words, ALE_STRANGER_WORDS, "not a byte comes from it");
        break;
    case ALE_STRANGER_NOISE:
        list_bytes(s, words);
        break;
    case ALE_STRANGER_TEXT:
        quote(s, "what speaks there is no URG", words);
        break;
    case ALE_STRANGER_NMEA:
        quote(s, "what speaks there is NMEA, as of a GPS receiver", words);
        break;
    case ALE_STRANGER_RPLIDAR:
        snprintf(words, ALE_STRANGER_WORDS, "what speaks there is an RPLIDAR, which is no URG");
        break;
    }
}
