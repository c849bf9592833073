/* Messages of LCM as they come through a pipe, in the form of lcm-logger's logs (lcm/event.h).
 *
 *   EventStream events(stdin);
 *   while (events.next(event)) ... */
#ifndef GRID_EVENT_STREAM_H
#define GRID_EVENT_STREAM_H

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace grid
{

struct Event {
    std::string channel;
    std::vector<uint8_t> data;
};

class EventStream
{
  public:
    /* It stays open. */
    explicit EventStream(FILE *file) : file_(file)
    {
    }

    /* False at the end, where the last event may be cut. Throws std::runtime_error where no event begins or
     * one is larger than any message. */
    bool next(Event &event);

  private:
    bool read(void *into, size_t count);

    FILE *file_;
};

} // namespace grid

#endif
