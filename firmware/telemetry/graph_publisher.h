/* ALE_GRAPH: the pose graph as the mapper thread has put it together, when it has changed, at most once a
 * second; the same every ten seconds, for those who came later. Telemetry thread only.
 *
 * Cost: one message of 13.4 kB at most, ten frames on the network; as much as one burst of map parts. */
#ifndef ALE_FIRMWARE_TELEMETRY_GRAPH_PUBLISHER_H
#define ALE_FIRMWARE_TELEMETRY_GRAPH_PUBLISHER_H

#include "exchange/exchange.h"
#include "lcm/bus.h"

typedef struct {
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    bool is_new;      /* a graph came in since the last one was sent */
    uint32_t version; /* of what was sent last; 0: nothing was */
    int64_t next_ns;
    int64_t next_again_ns;
} ale_graph_publisher_t;

/* Sends what is due. */
void ale_graph_publisher_work(ale_graph_publisher_t *publisher, int64_t now_ns);

/* The graph as it stands in the end, if it has changed since. */
void ale_graph_publisher_finish(ale_graph_publisher_t *publisher);

#endif
