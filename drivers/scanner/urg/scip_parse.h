/* Reader of what a SCIP 1.1 or 2.0 device sends: bytes in, in pieces of any size, whole replies out.
 *
 *   ale_scip_parser_t parser;  ale_scip_event_t event;
 *   ale_scip_parser_init(&parser);
 *   while (count > 0) {
 *       size_t used = ale_scip_parse(&parser, bytes, count, arrival_us, &event);
 *       bytes += used, count -= used;
 *       if (event.kind == ALE_SCIP_SCAN) ... event.stamp_ms, event.values[0 .. event.value_count-1]
 *   }
 *
 * A reply is echo LF status LF [lines] LF. The protocol is told by the status line: two characters and a
 * right sum are SCIP 2.0, one character is SCIP 1.1. Which command was asked is read from the echo; the
 * caller compares it with what it sent.
 *
 * Measurements are strict: every sum, the length of every line and the number of values must be right, or
 * the whole scan is ALE_SCIP_LOST. Information lines (VV, PP, II) are tolerant: they are handed out with
 * the note whether their sum was right, because units exist that send wrong ones.
 *
 * After damage the parser finds its feet at the next echo that is followed by a status; an echo of a
 * range request is recognised even behind garbage on the same line. What it skips is counted.
 *
 * No I/O, no clock, no allocation. Bounded: O(count) a call, with at most ALE_SCIP_LINE bytes looked at again
 * for each line end. One owner thread. */
#ifndef ALE_SCANNER_URG_SCIP_PARSE_H
#define ALE_SCANNER_URG_SCIP_PARSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/limits.h"
#include "scanner/urg/scip_line.h"
#include "scanner/urg/scip_request.h"

enum {
    ALE_SCIP_ECHO = 40,      /* longest echo kept, NUL included: 15 + ";" + 16 and some reserve */
    ALE_SCIP_BODY_LINES = 64 /* most lines of one reply: 1081 values in 3 characters make 51 */
};

typedef enum {
    ALE_SCIP_NONE,      /* all bytes used, nothing complete */
    ALE_SCIP_LINE_READ, /* one information line of a reply; text, text_count, sum_right */
    ALE_SCIP_REPLY,     /* a reply without ranges is complete: echo, status */
    ALE_SCIP_SCAN,      /* a reply with ranges is complete and right: all fields */
    ALE_SCIP_LOST       /* a reply with ranges came damaged: loss says how; stamp_ms if stamp_known */
} ale_scip_kind_t;

typedef enum {
    ALE_SCIP_INTACT,
    ALE_SCIP_BAD_SUM,   /* a sum is wrong */
    ALE_SCIP_BAD_SHAPE, /* a line of wrong length, an impossible character, a wrong status or echo */
    ALE_SCIP_BAD_COUNT, /* number of values differs from what the echo asks for, or exceeds the capacity */
    ALE_SCIP_CUT        /* the next reply began before this one ended */
} ale_scip_loss_t;

/* Pointers stay valid until the next call. */
typedef struct {
    ale_scip_kind_t kind;
    uint8_t protocol;         /* 1 or 2, by the status line */
    char echo[ALE_SCIP_ECHO]; /* NUL-terminated, as echoed, ";text" included */
    char status[3];           /* "00", "99", ...; SCIP 1.1: one character; "": unreadable */
    bool has_request;         /* the echo is a range request: request is filled */
    ale_scip_request_t request;
    bool stamp_known;
    uint32_t stamp_ms;     /* 24 bits */
    const int32_t *values; /* millimetres or error codes */
    uint32_t value_count;
    const char *text;    /* LINE_READ: the line without ";" and sum, NUL-terminated */
    uint32_t text_count; /* at most ALE_SCIP_LINE: a wrong sum without ";" is not told from the text */
    bool sum_right;
    ale_scip_loss_t loss;
    int64_t first_us; /* arrival of the reply's first byte, as given; late rather than early in doubt */
    int64_t last_us;  /* arrival of its last byte */
} ale_scip_event_t;

typedef struct {
    uint64_t bytes;
    uint64_t garbage_bytes;          /* outside any reply */
    uint64_t replies;                /* REPLY */
    uint64_t scans;                  /* SCAN */
    uint64_t lost[ALE_SCIP_CUT + 1]; /* LOST, by loss */
    uint64_t wrong_info_sums;
} ale_scip_counters_t;

/* Fields are private; copy and zero at will. */
typedef struct {
    uint8_t state;
    ale_scip_line_t line;
    int64_t now_us; /* arrival of the bytes being read */
    struct {        /* a line that is the echo of a reply if a status follows */
        char text[ALE_SCIP_ECHO];
        uint32_t count;
        uint32_t bytes; /* on the line, LF included: garbage if it is no echo */
        bool has_request;
        ale_scip_request_t request;
        int64_t us;
    } candidate;
    ale_scip_event_t reply; /* the reply being read */
    bool has_data;          /* ranges belong to it, or did before it was damaged */
    bool stamp_due;
    bool ended; /* a short data line was the last one */
    uint32_t body_lines;
    uint32_t expected; /* values */
    int32_t partial;   /* value that a line end cut, and how many of its characters were there */
    uint32_t partial_count;
    int32_t values[ALE_MAX_BEAMS];
    ale_scip_counters_t counters;
} ale_scip_parser_t;

void ale_scip_parser_init(ale_scip_parser_t *parser);

/* Takes bytes until the first event; returns how many were used (all of them with ALE_SCIP_NONE).
 * arrival_us: host time of these bytes, only handed through. */
size_t ale_scip_parse(ale_scip_parser_t *parser, const uint8_t *bytes, size_t count, int64_t arrival_us,
                      ale_scip_event_t *event);

/* Forgets a half-read reply (after reopening, after a change of baud rate); counters stay. */
void ale_scip_parser_reset(ale_scip_parser_t *parser);

/* Counts by parser since init. */
const ale_scip_counters_t *ale_scip_counters(const ale_scip_parser_t *parser);

#endif
