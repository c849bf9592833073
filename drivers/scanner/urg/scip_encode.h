/* Writer of SCIP: replies as a device sends them. Pure functions on a buffer of the caller.
 *
 *   uint8_t bytes[4096];
 *   ale_scip_writer_t out = {bytes, sizeof bytes, 0, false};
 *   ale_scip_put_echo(&out, "GD0044072501");
 *   ale_scip_put_status(&out, "00");
 *   ale_scip_put_stamp(&out, stamp_ms);
 *   ale_scip_put_values(&out, ALE_SCIP_2, values, 682, 3);
 *   ale_scip_put_end(&out);                      -> out.used bytes, unless out.overflow
 *
 * What does not fit is left out whole and `overflow` is set; it stays set. */
#ifndef ALE_SCANNER_URG_SCIP_ENCODE_H
#define ALE_SCANNER_URG_SCIP_ENCODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ALE_SCIP_1 = 1, ALE_SCIP_2 = 2 };

typedef struct {
    uint8_t *bytes;
    size_t capacity;
    size_t used;
    bool overflow;
} ale_scip_writer_t;

/* First line of a reply. */
void ale_scip_put_echo(ale_scip_writer_t *out, const char *text);
/* SCIP 2.0: two characters and their sum. SCIP 1.1: give one character, it goes out alone. */
void ale_scip_put_status(ale_scip_writer_t *out, const char *status);
/* SCIP 2.0: "KEY:value;" and the sum, in which ";" is not added. */
void ale_scip_put_info(ale_scip_writer_t *out, const char *key, const char *value);
/* SCIP 1.1: a line as it is ("KEY:value"). */
void ale_scip_put_plain(ale_scip_writer_t *out, const char *text);
/* SCIP 2.0: 24 bits of milliseconds in 4 characters, and the sum. */
void ale_scip_put_stamp(ale_scip_writer_t *out, uint32_t stamp_ms);
/* Values in 2 or 3 characters, cut in lines of 64, each with its sum (SCIP 2.0) or without (1.1).
 * Values saturate at 0 and at what the characters can hold (4095, 262143). */
void ale_scip_put_values(ale_scip_writer_t *out, int protocol, const int32_t *values, uint32_t count,
                         unsigned characters);
/* The empty line that ends a reply. */
void ale_scip_put_end(ale_scip_writer_t *out);

#endif
