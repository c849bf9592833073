/* LCM event logs (lcm/event.h), as lcm-logger writes them and ale-replay and lcm-logplayer read them.
 *
 * Written and read here and not by liblcm: of a full disk it leaves half an event and no word, and a file may
 * have been written by anybody. */
#ifndef CONSOLE_EVENT_FILE_H
#define CONSOLE_EVENT_FILE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "operator/console/recordings/descriptor.h"

namespace console
{

class EventWriter
{
  public:
    /* The file, empty and open for writing. */
    explicit EventWriter(Descriptor file) : file_(std::move(file))
    {
    }

    /* Waits in memory until it is flushed. */
    void put(int64_t received_us, const std::string &channel, const uint8_t *bytes, size_t count);

    /* How many bytes would wait if this were put, too. */
    size_t with(const std::string &channel, size_t count) const;

    /* 0, or errno: then the file ends with the last event that is whole, and what was put since is gone. */
    int flush();

    /* Events and bytes that are in the file. */
    uint64_t events() const
    {
        return events_;
    }
    uint64_t bytes() const
    {
        return bytes_;
    }

  private:
    void keep_whole(size_t written);

    Descriptor file_;
    std::vector<uint8_t> waiting_;
    std::vector<size_t> ends_; /* of the events that wait */
    int64_t number_ = 0;
    uint64_t events_ = 0;
    uint64_t bytes_ = 0;
};

/* What was skipped, since no event can be made of it. */
struct Damage {
    uint64_t places = 0;
    uint64_t bytes = 0; /* 0: nobody has counted them */
};

/* For people: "2 damaged places, 5.8 kB, left out". Empty: no place. */
std::string damage_words(const Damage &damage);

/* Where an event lies in its file. */
struct EventPlace {
    int64_t received_us = 0;
    std::string channel;
    uint64_t data_at = 0;
    uint32_t data_bytes = 0;
};

class EventReader
{
  public:
    /* From the first event at or behind `from` on; `from` need not be where one begins. The file must stay
     * open. Throws std::runtime_error with the system's words. */
    explicit EventReader(const Descriptor &file, uint64_t from = 0);

    /* False at the end. What is damaged is skipped up to the next event. */
    bool next(EventPlace &event);

    uint64_t size() const
    {
        return size_;
    }
    /* So far. */
    const Damage &damage() const
    {
        return damage_;
    }

  private:
    const uint8_t *look(uint64_t at, size_t count);
    bool take(EventPlace &event);
    void skip_damage();
    uint64_t next_sync(uint64_t at);

    int file_;
    uint64_t size_ = 0;
    uint64_t at_;
    Damage damage_;
    uint64_t damage_end_ = UINT64_MAX;
    uint64_t window_at_ = 0;
    std::vector<uint8_t> window_;
};

/* The bytes of an event; fewer when the file has been cut meanwhile. */
std::vector<uint8_t> data_of(const Descriptor &file, const EventPlace &event);

} // namespace console

#endif
