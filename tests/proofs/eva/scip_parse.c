/* One byte to the parser of SCIP, whatever it is and whatever came before: the state is any that
 * `unknown_state` allows, and must be such a state again, so that by induction no row of bytes leads out of
 * it. A longer piece is the same loop again.
 *
 * proves: drivers/scanner/urg/scip_parse.c drivers/scanner/urg/scip_line.c
 *  drivers/scanner/urg/scip_request.c drivers/scanner/urg/scip_code.c
 * options: -eva-precision 0 -eva-auto-loop-unroll 20 -eva-split-return full
 *  -eva-slevel-function keep_candidate:20 */
#include "unknown.h"

#include "scanner/urg/scip_code.h"
#include "scanner/urg/scip_parse.h"

/* What a line keeps when it has grown too long; values are of three characters at most. */
enum { LEAST_KEPT = ALE_SCIP_LINE / 2, MOST_VALUE = (1 << 18) - 1, STATES = 3, BODY = 2, SHORT_LINE = 17 };

static ale_scip_parser_t parser;
static ale_scip_event_t event;

static void unknown_request(ale_scip_request_t *request)
{
    Frama_C_make_unknown((char *)request, sizeof *request);
    request->stream = unknown(0, 1);
}

static void unknown_reply(ale_scip_event_t *reply)
{
    Frama_C_make_unknown((char *)reply, sizeof *reply);
    unknown_request(&reply->request);
    reply->kind = (ale_scip_kind_t)unknown(0, ALE_SCIP_LOST);
    reply->loss = (ale_scip_loss_t)unknown(0, ALE_SCIP_CUT);
    reply->status[sizeof reply->status - 1] = '\0';
    reply->has_request = unknown(0, 1);
    reply->stamp_known = unknown(0, 1);
    reply->sum_right = unknown(0, 1);
    reply->values = NULL;
    reply->text = NULL;
    reply->text_count = 0;
    reply->value_count = (uint32_t)unknown(0, ALE_MAX_BEAMS);
}

static void unknown_state(uint8_t state, uint32_t least_count, uint32_t most_count)
{
    Frama_C_make_unknown((char *)&parser, sizeof parser);
    parser.state = state;
    parser.line.count = (uint32_t)unknown(least_count, most_count);
    parser.line.dropped = least_count < LEAST_KEPT ? 0 : (uint32_t)unknown(0, UINT32_MAX);
    parser.candidate.count = (uint32_t)unknown(0, ALE_SCIP_ECHO - 1);
    parser.candidate.has_request = unknown(0, 1);
    unknown_request(&parser.candidate.request);
    unknown_reply(&parser.reply);
    parser.has_data = unknown(0, 1);
    parser.stamp_due = unknown(0, 1);
    parser.ended = unknown(0, 1);
    parser.partial = (int32_t)unknown(0, MOST_VALUE);
}

static void take(uint8_t byte)
{
    const size_t used = ale_scip_parse(&parser, &byte, 1, unknown(INT64_MIN, INT64_MAX), &event);
    //@ assert used == 1;
    //@ assert parser.state < STATES && parser.line.count <= ALE_SCIP_LINE;
    //@ assert parser.line.dropped > 0 ==> parser.line.count >= LEAST_KEPT;
    //@ assert parser.candidate.count < ALE_SCIP_ECHO;
    //@ assert parser.reply.text_count == 0 && parser.reply.status[2] == 0;
    //@ assert 0 <= parser.reply.loss <= ALE_SCIP_CUT;
    //@ assert parser.reply.value_count <= ALE_MAX_BEAMS && 0 <= parser.partial <= MOST_VALUE;
    //@ assert event.kind == ALE_SCIP_SCAN ==> event.value_count <= ALE_MAX_BEAMS;
    //@ assert event.text_count <= ALE_SCIP_LINE;
}

static void end_line(uint32_t least_count, uint32_t most_count)
{
    //@ loop unroll 3;
    for (uint8_t state = 0; state < STATES; state++) {
        unknown_state(state, least_count, most_count);
        take('\n');
    }
}

/* The end of a line of every length, in every state: a short line, of which parts may be missing, by itself.
 */
static void end_lines(void)
{
    //@ loop unroll 17;
    for (uint32_t count = 0; count < SHORT_LINE; count++) {
        end_line(count, count);
    }
    end_line(SHORT_LINE, LEAST_KEPT - 1);
    end_line(LEAST_KEPT, ALE_SCIP_LINE);
}

static void go_on(void)
{
    unknown_state((uint8_t)unknown(0, BODY), 0, LEAST_KEPT - 1);
    take((uint8_t)unknown('\n' + 1, UINT8_MAX));
    unknown_state((uint8_t)unknown(0, BODY), LEAST_KEPT, ALE_SCIP_LINE);
    take((uint8_t)unknown('\n' + 1, UINT8_MAX));
    unknown_state((uint8_t)unknown(0, BODY), 0, LEAST_KEPT - 1);
    take((uint8_t)unknown(0, '\n' - 1));
}

static void requests(void)
{
    ale_scip_request_t a;
    ale_scip_request_t b;
    char text[ALE_SCIP_REQUEST_TEXT];
    unknown_request(&a);
    unknown_request(&b);
    ale_scip_request_same_ranges(&a, &b);
    ale_scip_request_values(&a);
    ale_scip_request_frame_bytes(&a);
    ale_scip_request_format(&a, text);
    uint8_t characters[4];
    ale_scip_encode((uint32_t)unknown(0, UINT32_MAX), (unsigned)unknown(1, 4), characters);
}

void main(void)
{
    ale_scip_parser_init(&parser);
    end_lines();
    go_on();
    ale_scip_parser_reset(&parser);
    ale_scip_counters(&parser);
    requests();
}
