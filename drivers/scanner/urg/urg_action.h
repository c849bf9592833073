/* What the conversation with the sensor, or the judgement of its frames, wants done. They return it as a
 * value; the device alone does it. */
#ifndef ALE_SCANNER_URG_URG_ACTION_H
#define ALE_SCANNER_URG_URG_ACTION_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    ALE_URG_REST,     /* nothing on the port: an answer, a frame or the deadline comes next */
    ALE_URG_SEND,     /* send `line` */
    ALE_URG_SET_BAUD, /* set the port to `baud`, and tell the dialogue how that went */
    ALE_URG_FAIL,     /* the stream does no good: the ladder of recovery says what is next */
    ALE_URG_RESTART,  /* stop the stream and start it again */
    ALE_URG_RESET,    /* the same with a reset of the sensor between */
    ALE_URG_REOPEN    /* close the port, open it after a pause */
} ale_urg_deed_t;

/* What happens to the stream, in this order. */
enum {
    ALE_URG_STREAM_DESCRIBE = 1, /* by the geometry of the dialogue's identity */
    ALE_URG_STREAM_FORGET_CLOCK = 2,
    ALE_URG_STREAM_INTERRUPT = 4,
    ALE_URG_STREAM_BEGIN = 8 /* with the dialogue's request */
};

enum { ALE_URG_LINE = 28, ALE_URG_REASON = 160 };

/* Zeroed: nothing at all. Done from top to bottom. */
typedef struct {
    const char *reason; /* the new status in plain words, valid until the next call; NULL: as it was */
    uint32_t stream;    /* ALE_URG_STREAM_ bits */
    bool identified;    /* the dialogue's identity is news */
    int32_t wait_ms;    /* new deadline, from now; 0: as it was */
    ale_urg_deed_t deed;
    int32_t baud;            /* SET_BAUD */
    char line[ALE_URG_LINE]; /* SEND */
} ale_urg_action_t;

#endif
