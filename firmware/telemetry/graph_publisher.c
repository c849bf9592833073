#include "telemetry/graph_publisher.h"

#define PERIOD_NS 1000000000
#define AGAIN_NS 10000000000

static void send_graph(ale_graph_publisher_t *publisher, const ale_mapper_graph_t *graph)
{
    const ale_clock_t *clock = &publisher->exchange->clock;
    publisher->version += publisher->is_new ? 1 : 0;
    publisher->is_new = false;
    ale_bus_send_graph(publisher->bus, graph, ale_clock_to_utime(clock, ale_clock_now_us(clock)),
                       publisher->version);
}

static const ale_mapper_graph_t *newest_graph(ale_graph_publisher_t *publisher)
{
    bool fresh = false;
    const ale_mapper_graph_t *graph = ale_snapshot_newest(publisher->exchange->graph, &fresh);
    publisher->is_new = publisher->is_new || fresh;
    return graph;
}

void ale_graph_publisher_work(ale_graph_publisher_t *publisher, int64_t now_ns)
{
    const ale_mapper_graph_t *graph = newest_graph(publisher);
    const bool again = publisher->version > 0 && now_ns >= publisher->next_again_ns;
    if ((publisher->is_new && now_ns >= publisher->next_ns) || again) {
        send_graph(publisher, graph);
        publisher->next_ns = now_ns + PERIOD_NS;
        publisher->next_again_ns = now_ns + AGAIN_NS;
    }
}

void ale_graph_publisher_finish(ale_graph_publisher_t *publisher)
{
    const ale_mapper_graph_t *graph = newest_graph(publisher);
    if (publisher->is_new) {
        send_graph(publisher, graph);
    }
}
