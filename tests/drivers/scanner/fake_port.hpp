// A device in virtual time behind the port functions: whoever includes this file gets ale_port_* from here,
// so that a minute of faults takes milliseconds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

extern "C" {
#include "serial/port.h"
}

namespace ale_test
{

class FakeDevice
{
  public:
    virtual ~FakeDevice() = default;

    // How it is wired, and what befalls it: intervals of virtual time.
    bool is_rs232 = false;
    int64_t silent_from_us = -1, silent_to_us = -1;
    int64_t absent_from_us = -1, absent_to_us = -1;

    int64_t now_us = 5000000;
    int opened = 0;
    bool open = false;
    int32_t port_baud = 0;
    int dtr = -1; // 1 on, 0 off, -1 never set

    bool plugged() const
    {
        return now_us < absent_from_us || now_us >= absent_to_us;
    }
    bool silent() const
    {
        return now_us >= silent_from_us && now_us < silent_to_us;
    }
    // Moves virtual time; true as soon as there is something to read.
    bool pass(int64_t until_us)
    {
        while (now_us < until_us && output_.empty()) {
            now_us = std::min(until_us, std::max(now_us + 1, next_us()));
            live();
        }
        return !output_.empty();
    }
    std::string take(size_t most)
    {
        const std::string out = output_.substr(0, most);
        output_.erase(0, out.size());
        return out;
    }
    virtual void clear_line()
    {
        output_.clear();
    }
    virtual void hear(const std::string &bytes) = 0;

  protected:
    // When something happens next; what has happened by now.
    virtual int64_t next_us() const = 0;
    virtual void live() = 0;

    std::string output_;
};

inline FakeDevice *on_the_line = nullptr;

inline int64_t time_on_the_line(void *)
{
    return on_the_line->now_us;
}

} // namespace ale_test

extern "C" {

struct ale_port {
    bool gone;
};

inline ale_port the_port;

int ale_port_open(ale_port_t **out, const char *, int32_t baud)
{
    ale_test::FakeDevice *s = ale_test::on_the_line;
    *out = nullptr;
    if (!s->plugged()) {
        return ALE_PORT_ABSENT;
    }
    the_port = {false};
    *out = &the_port;
    s->clear_line();
    s->open = true;
    s->opened++;
    s->port_baud = baud;
    return ALE_PORT_OK;
}

int ale_port_set_baud(ale_port_t *, int32_t baud)
{
    ale_test::on_the_line->port_baud = baud;
    return ALE_PORT_OK;
}

int ale_port_set_dtr(ale_port_t *, bool on)
{
    ale_test::on_the_line->dtr = on ? 1 : 0;
    return ALE_PORT_OK;
}

int ale_port_wait(ale_port_t *port, int32_t timeout_ms)
{
    ale_test::FakeDevice *s = ale_test::on_the_line;
    const int64_t until_us = s->now_us + int64_t{1000} * timeout_ms;
    if (port == nullptr) {
        const bool open = s->open;
        s->open = false; // what is sent to a closed port is lost
        s->pass(until_us);
        s->open = open;
        return 0;
    }
    const bool readable = s->pass(until_us);
    the_port.gone = the_port.gone || !s->plugged();
    if (the_port.gone) {
        return ALE_PORT_GONE;
    }
    return readable ? 1 : 0;
}

int ale_port_read(ale_port_t *, uint8_t *bytes, size_t capacity)
{
    const std::string taken = ale_test::on_the_line->take(capacity);
    std::copy(taken.begin(), taken.end(), bytes);
    return static_cast<int>(taken.size());
}

int ale_port_write(ale_port_t *, const uint8_t *bytes, size_t count, int32_t)
{
    ale_test::FakeDevice *s = ale_test::on_the_line;
    if (the_port.gone || !s->plugged()) {
        return ALE_PORT_GONE;
    }
    s->hear(std::string(bytes, bytes + count));
    return ALE_PORT_OK;
}

bool ale_port_has_baud(const ale_port_t *)
{
    return ale_test::on_the_line->is_rs232;
}

void ale_port_close(ale_port_t *)
{
    ale_test::on_the_line->open = false;
    ale_test::on_the_line->clear_line();
}

const char *ale_port_strerror(int status)
{
    return status == ALE_PORT_ABSENT ? "absent" : "gone";
}

void ale_port_explain(int status, const char *, char words[ALE_PORT_WORDS])
{
    std::snprintf(words, ALE_PORT_WORDS, "%s", ale_port_strerror(status));
}
}
