/* What a robot vouches for: its status, and the newest poses that it has sent. Filled by the bus. */
#ifndef ALE_LCM_VOUCH_H
#define ALE_LCM_VOUCH_H

#include <stddef.h>
#include <stdint.h>

#include <lcmtypes_ale_status_t.h>

#include "command/keys.h"

enum { ALE_VOUCHED_POSES = 32 };

/* All zero: nothing to vouch with. */
typedef struct {
    const ale_secret_key_t *key; /* NULL: none */
    int32_t clock_ppm;
    int64_t counter;
    uint64_t sent; /* poses; the newest stand in: */
    int32_t pose_scan[ALE_VOUCHED_POSES];
    int64_t pose_digest[ALE_VOUCHED_POSES];
} ale_vouch_t;

/* A pose goes out: these are its bytes. */
void ale_vouch_pose(ale_vouch_t *vouch, int32_t scan, const uint8_t *bytes, size_t count);

/* The bytes of an ALE_VOUCHED with that status, signed; their number, or -1 when they do not fit. */
int ale_vouch_encode(ale_vouch_t *vouch, const lcmtypes_ale_status_t *status, uint8_t *bytes, int capacity);

#endif
