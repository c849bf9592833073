/* Who speaks on a port where no URG answers: told by the bytes that came. Pure. */
#ifndef ALE_SCANNER_URG_STRANGER_H
#define ALE_SCANNER_URG_STRANGER_H

#include <stdint.h>

enum { ALE_STRANGER_BYTES = 128, ALE_STRANGER_WORDS = 96 };

/* In this order: what is told of the more is believed, for at another rate anything looks like noise. */
typedef enum {
    ALE_STRANGER_SILENT,
    ALE_STRANGER_NOISE,
    ALE_STRANGER_TEXT,
    ALE_STRANGER_NMEA,    /* lines $......,...*hh as of a GPS receiver (NMEA 0183) */
    ALE_STRANGER_RPLIDAR, /* its descriptors, its measurements, or what it says when it is switched on */
} ale_stranger_kind_t;

/* Fields are private. */
typedef struct {
    ale_stranger_kind_t kind; /* of all rates that have been tried */
    uint8_t told[ALE_STRANGER_BYTES];
    uint32_t told_count;
    uint8_t bytes[ALE_STRANGER_BYTES]; /* the last ones at the present rate */
    uint32_t count;
} ale_stranger_t; /* begins zeroed */

/* Bytes that came and were no answer; any number. O(count). */
void ale_stranger_hear(ale_stranger_t *stranger, const uint8_t *bytes, uint32_t count);

/* What was heard at this rate is judged, and forgotten but for what it tells: before another rate, or at the
 * end. O(ALE_STRANGER_BYTES). */
void ale_stranger_judge(ale_stranger_t *stranger);

/* What the bytes are, in plain words: "not a byte comes from it", "it speaks NMEA, as a GPS receiver does:
 * $GPGGA,1234". Printable ASCII. O(ALE_STRANGER_BYTES). */
void ale_stranger_words(const ale_stranger_t *stranger, char words[ALE_STRANGER_WORDS]);

#endif
