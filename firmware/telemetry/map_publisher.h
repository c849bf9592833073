/* Which map the world sees, and when it goes out: for the telemetry thread.
 *
 * It is the one that was drawn anew (map_drawer.h); until there is a drawing, the tracker's. A drawing is of
 * the map that the robot is in: walls of others, which are not joined with it, are added as the tracker has
 * them. One that is new goes out whole, a second after the last one at the earliest, in bursts that leave
 * room for poses; the same again every ten seconds, for those who came later or missed a part. */
#ifndef ALE_FIRMWARE_TELEMETRY_MAP_PUBLISHER_H
#define ALE_FIRMWARE_TELEMETRY_MAP_PUBLISHER_H

#include "exchange/exchange.h"
#include "lcm/bus.h"

#define ALE_MAP_PART_NS 1000000 /* between bursts of map parts */

typedef struct {
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    bool tracked_is_new;  /* the tracker's map came in since it was last asked for what to show */
    bool drawn;           /* what is shown is not the tracker's */
    bool begun;           /* something is shown */
    ale_map_t shown;      /* its version is this one's, so that it grows whoever made the map */
    ale_map_t sent;       /* the same with the walls of other maps */
    int16_t pieces_parts; /* parts of ALE_MAP_PIECES, which go before those of ALE_MAP */
    int16_t next_part;    /* of both; all sent: the number of parts */
    int64_t next_ns;
    int64_t next_whole_ns;
} ale_map_publisher_t;

/* exchange and bus must outlive it. */
void ale_map_publisher_init(ale_map_publisher_t *publisher, ale_exchange_t *exchange, ale_bus_t *bus);

/* Sends what is due. epoch: of the newest pose. */
void ale_map_publisher_work(ale_map_publisher_t *publisher, uint32_t epoch, int64_t now_ns);

/* Parts are waiting: the next burst is due in ALE_MAP_PART_NS. */
bool ale_map_publisher_is_busy(const ale_map_publisher_t *publisher);

/* Sends the map as it stands in the end; takes a tenth of a second for the largest. */
void ale_map_publisher_finish(ale_map_publisher_t *publisher, uint32_t epoch);

/* What is sent now, or was sent last; NULL before the first. Valid until the next call of another function.
 */
const ale_map_t *ale_map_publisher_map(const ale_map_publisher_t *publisher);

/* The tracker's newest map, a second old at most: what the newest pose was found in. Empty before the first.
 * Valid until the next call of this or of work.
 */
const ale_tracked_map_t *ale_map_publisher_tracked(ale_map_publisher_t *publisher);

#endif
