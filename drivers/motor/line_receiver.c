#include "motor/line_receiver.h"

#include <stdlib.h>
#include <string.h>

static const char HEAD[] = "$ALE,";

uint16_t ale_motor_crc(const char *text, size_t count)
{
    uint16_t sum = 0xFFFF;
    for (size_t k = 0; k < count; k++) {
        sum = (uint16_t)(sum ^ (uint16_t)((uint8_t)text[k] << 8));
        for (int bit = 0; bit < 8; bit++) {
            sum = (uint16_t)(sum & 0x8000 ? (sum << 1) ^ 0x1021 : sum << 1);
        }
    }
    return sum;
}

/* A number and what ends it; what is cut off, or has more in it, has another checksum. */
static bool number(const char **at, char end, long *value)
{
    char *rest = NULL;
    *value = strtol(*at, &rest, 10);
    const bool fine = rest != *at && *rest == end;
    *at = rest + 1;
    return fine;
}

static bool take(ale_motor_line_t *line, uint32_t now_ms)
{
    const char *at = line->text + sizeof HEAD - 1;
    const char *sum = strchr(line->text, '*');
    long counter = 0;
    long v = 0;
    long w = 0;
    if (strncmp(line->text, HEAD, sizeof HEAD - 1) != 0 || !sum || strlen(sum) != 5 ||
        strspn(sum + 1, "0123456789ABCDEF") != 4 ||
        strtoul(sum + 1, NULL, 16) != ale_motor_crc(line->text + 1, (size_t)(sum - line->text) - 1) ||
        !number(&at, ',', &counter) || !number(&at, ',', &v) || !number(&at, '*', &w) ||
        (line->moves && (uint32_t)counter == line->counter)) {
        return false;
    }
    line->counter = (uint32_t)counter;
    line->v_mm_s = (int32_t)v;
    line->w_mrad_s = (int32_t)w;
    line->taken_ms = now_ms;
    line->moves = true;
    return true;
}

bool ale_motor_byte(ale_motor_line_t *line, char byte, uint32_t now_ms)
{
    if (byte == '$' || line->length == ALE_MOTOR_LINE - 1) {
        line->length = 0;
    }
    if (byte == '\r' || byte == '\n') {
        line->text[line->length] = '\0';
        line->length = 0;
        return take(line, now_ms);
    }
    line->text[line->length++] = byte;
    return false;
}

void ale_motor_line_set_point(ale_motor_line_t *line, uint32_t now_ms, int32_t *v_mm_s, int32_t *w_mrad_s)
{
    line->moves = line->moves && now_ms - line->taken_ms < ALE_MOTOR_LINE_DEAD_MAN_MS;
    *v_mm_s = line->moves ? line->v_mm_s : 0;
    *w_mrad_s = line->moves ? line->w_mrad_s : 0;
}
