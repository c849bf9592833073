#include "scanner/rotary/diagnosis.h"

#include <stdio.h>

enum { MDEG_A_TURN = 360000, SLOW_PERCENT = 80, RIGHT_PERCENT = 85 };

/* Less than a quarter of a turn while scans are long overdue: turning slowly is something else. */
static const uint32_t stands_still = UINT32_C(1) << 30;

static void explain_no_packet(const ale_rotary_protocol_t *protocol, const ale_line_seen_t *seen,
                              int32_t baud, char words[ALE_DIAGNOSIS_WORDS])
{
    if (seen->bytes == 0) {
        snprintf(words, ALE_DIAGNOSIS_WORDS,
                 "not a byte comes from it: is it supplied with 5 V, and its data wire connected?");
    } else if (seen->answers > 0) {
        snprintf(words, ALE_DIAGNOSIS_WORDS,
                 "it answers, but measures nothing: its motor does not turn, or its 5 V supply sags");
    } else {
        snprintf(
            words, ALE_DIAGNOSIS_WORDS,
            "%u bytes at %d bit/s and no packet among them: a wrong rate, or no scanner of this type (%s)",
            (unsigned)seen->bytes, (int)baud, protocol->name);
    }
}

void ale_diagnosis_no_scan(const ale_rotary_protocol_t *protocol, const ale_line_seen_t *seen, int32_t baud,
                           char words[ALE_DIAGNOSIS_WORDS])
{
    if (seen->packets == 0) {
        explain_no_packet(protocol, seen, baud, words);
    } else if (seen->damaged > seen->packets) {
        snprintf(words, ALE_DIAGNOSIS_WORDS, "%u of %u packets are damaged: a bad wire, or too long a one",
                 (unsigned)seen->damaged, (unsigned)(seen->damaged + seen->packets));
    } else if (seen->turned < stands_still) {
        snprintf(words, ALE_DIAGNOSIS_WORDS,
                 "its motor does not turn: something holds it, or its 5 V supply sags");
    } else {
        snprintf(words, ALE_DIAGNOSIS_WORDS, "no whole turn comes from it");
    }
}

bool ale_diagnosis_slow(const ale_rotary_protocol_t *protocol, int32_t speed_mdeg_s, bool was_slow,
                        char words[ALE_DIAGNOSIS_WORDS])
{
    const int64_t percent = was_slow ? RIGHT_PERCENT : SLOW_PERCENT;
    const bool slow = speed_mdeg_s > 0 && (int64_t)speed_mdeg_s * 100 < protocol->turns_mdeg_s * percent;
    if (slow) {
        const int32_t tenths = speed_mdeg_s / (MDEG_A_TURN / 10);
        snprintf(words, ALE_DIAGNOSIS_WORDS,
                 "its head turns %d.%d times a second instead of %d: its 5 V supply sags, or it is slowed",
                 (int)(tenths / 10), (int)(tenths % 10), (int)(protocol->turns_mdeg_s / MDEG_A_TURN));
    }
    return slow;
}
