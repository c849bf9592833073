/* The motor controller's side of set points: small enough for a microcontroller, with nothing but C. It takes
 * ALE_DRIVE_KEYED as bytes and says what the motors are to do; whatever is not the robot's own and of now is
 * not taken, and 300 ms without a new one the motors stand. README.md says what is checked and why.
 *
 *   ale_motor_t motor = {.next = a random number other than 0, drawn at every start};
 *   memcpy(motor.key, the 32 bytes of drive.key, 32);
 *   ale_motor_take(&motor, bytes, count, millis());              (for each message)
 *   ale_motor_set_point(&motor, millis(), &v_um_s, &w_urad_s);   (as often as the motors are told)
 *   count = ale_motor_ready(&motor, bytes);                      (twice a second, on ALE_DRIVE_READY)
 *
 * now_ms: any clock that runs evenly; it may wrap. One caller. No call takes more than some microseconds. */
#ifndef ALE_MOTOR_RECEIVER_H
#define ALE_MOTOR_RECEIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ALE_MOTOR_KEY = 32, ALE_MOTOR_MESSAGE = 56, ALE_MOTOR_READY = 40, ALE_MOTOR_DEAD_MAN_MS = 300 };

typedef struct {
    uint8_t key[ALE_MOTOR_KEY];
    uint64_t next;     /* nonce for another start of the robot */
    uint64_t heard;    /* which start of the robot the newest message with a right tag is of, */
    uint64_t utime;    /* and what its clock says there */
    uint64_t boot;     /* of the last one taken, */
    uint64_t nonce;    /* its nonce */
    uint64_t counter;  /* and its counter; 0: none was taken yet */
    uint32_t lead_ms;  /* the robot's clock less this one, by the message that was held up least */
    uint32_t taken_ms; /* when the last one was taken */
    bool moves;        /* one was taken, and is not older than the dead-man allows */
    int32_t v_um_s, w_urad_s;
} ale_motor_t;

/* Any bytes. Whether they were taken: with a key of zeros, which is none, nothing is. */
bool ale_motor_take(ale_motor_t *motor, const uint8_t *bytes, size_t count, uint32_t now_ms);

/* What the motors are to do now: both zero when nothing was taken for ALE_MOTOR_DEAD_MAN_MS. */
void ale_motor_set_point(ale_motor_t *motor, uint32_t now_ms, int32_t *v_um_s, int32_t *w_urad_s);

/* The bytes of an ALE_DRIVE_READY. */
size_t ale_motor_ready(const ale_motor_t *motor, uint8_t bytes[ALE_MOTOR_READY]);

/* SipHash-2-4 of up to any bytes with a key of 16. */
uint64_t ale_siphash(const uint8_t *key, const uint8_t *bytes, size_t count);

#ifdef __cplusplus
}
#endif

#endif
