#include "scanner/urg/scip_encode.h"

#include <string.h>

#include "scanner/urg/scip_code.h"

enum { LINE_DATA = 64, LF = '\n', STAMP_CHARACTERS = 4, VALUE_CHARACTERS = 3 };

/* One line of two parts and the characters behind them, whole or not at all. */
static void put(ale_scip_writer_t *out, const uint8_t *bytes, size_t count, const uint8_t *tail,
                size_t tail_count)
{
    if (out->overflow || out->capacity - out->used < count + tail_count) {
        out->overflow = true;
        return;
    }
    memcpy(out->bytes + out->used, bytes, count);
    memcpy(out->bytes + out->used + count, tail, tail_count);
    out->used += count + tail_count;
}

static void put_unsummed(ale_scip_writer_t *out, const uint8_t *bytes, size_t count)
{
    const uint8_t tail[] = {LF};
    put(out, bytes, count, tail, sizeof tail);
}

static void put_summed(ale_scip_writer_t *out, const uint8_t *bytes, size_t count)
{
    const uint8_t tail[] = {ale_scip_sum(bytes, count), LF};
    put(out, bytes, count, tail, sizeof tail);
}

void ale_scip_put_echo(ale_scip_writer_t *out, const char *text)
{
    put_unsummed(out, (const uint8_t *)text, strlen(text));
}

void ale_scip_put_status(ale_scip_writer_t *out, const char *status)
{
    const size_t count = strlen(status);
    if (count == 1) {
        put_unsummed(out, (const uint8_t *)status, count);
    } else {
        put_summed(out, (const uint8_t *)status, count);
    }
}

void ale_scip_put_info(ale_scip_writer_t *out, const char *key, const char *value)
{
    const size_t key_count = strlen(key);
    const size_t value_count = strlen(value);
    if (out->overflow || out->capacity - out->used < key_count + value_count + sizeof ":;x\n" - 1) {
        out->overflow = true;
        return;
    }
    const size_t begin = out->used;
    put(out, (const uint8_t *)key, key_count, (const uint8_t *)":", 1);
    put(out, (const uint8_t *)value, value_count, (const uint8_t *)"", 0);
    const uint8_t tail[] = {';', ale_scip_sum(out->bytes + begin, out->used - begin), LF};
    put(out, tail, sizeof tail, (const uint8_t *)"", 0);
}

void ale_scip_put_plain(ale_scip_writer_t *out, const char *text)
{
    put_unsummed(out, (const uint8_t *)text, strlen(text));
}

void ale_scip_put_stamp(ale_scip_writer_t *out, uint32_t stamp_ms)
{
    uint8_t text[STAMP_CHARACTERS];
    ale_scip_encode(stamp_ms, STAMP_CHARACTERS, text);
    put_summed(out, text, sizeof text);
}

void ale_scip_put_values(ale_scip_writer_t *out, int protocol, const int32_t *values, uint32_t count,
                         unsigned characters)
{
    const int32_t most = (1 << (6 * characters)) - 1;
    /* Room for a full line and the part of a value that runs over its end. */
    uint8_t line[LINE_DATA + VALUE_CHARACTERS];
    size_t used = 0;
    for (uint32_t k = 0; k < count; k++) {
        const int32_t value = values[k] < 0 ? 0 : (values[k] > most ? most : values[k]);
        ale_scip_encode((uint32_t)value, characters, line + used);
        used += characters;
        const bool last = k + 1 == count;
        while (used >= LINE_DATA || (last && used > 0)) {
            const size_t cut = used < LINE_DATA ? used : LINE_DATA;
            if (protocol == ALE_SCIP_1) {
                put_unsummed(out, line, cut);
            } else {
                put_summed(out, line, cut);
            }
            used -= cut;
            memmove(line, line + cut, used);
        }
    }
}

void ale_scip_put_end(ale_scip_writer_t *out)
{
    put_unsummed(out, (const uint8_t *)"", 0);
}
