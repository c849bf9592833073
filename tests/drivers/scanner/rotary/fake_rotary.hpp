// A rotary scanner in virtual time behind the port functions: whoever includes this file gets ale_port_* from
// here, so that a minute of faults takes milliseconds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

extern "C" {
#include "serial/port.h"
}

namespace ale_test
{

class FakeRotary
{
  public:
    virtual ~FakeRotary() = default;

    // How it is wired, and what befalls it: intervals of virtual time.
    bool is_rs232 = false;
    int32_t sensor_baud = 230400;
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
    // Moves virtual time; true as soon as there is something to read.
    bool pass(int64_t until_us)
    {
        while (now_us < until_us && output_.empty()) {
            now_us = std::min(until_us, std::max(now_us + 1, next_us()));
            if (!was_plugged_ && plugged()) {
                power_up();
            }
            was_plugged_ = plugged();
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
    void clear_line()
    {
        output_.clear();
    }
    virtual void hear(const std::string &)
    {
    }

  protected:
    // When it has something to say; what it says by now.
    virtual int64_t next_us() const = 0;
    virtual void live() = 0;
    virtual void power_up()
    {
    }
    void say(const std::string &bytes)
    {
        const bool silent = now_us >= silent_from_us && now_us < silent_to_us;
        if (open && !silent && plugged()) {
            output_ += port_baud == sensor_baud ? bytes : std::string(bytes.size() / 2, '\xfe');
        }
    }

  private:
    std::string output_;
    bool was_plugged_ = true;
};

inline FakeRotary *rotary_on_the_line = nullptr;

inline int64_t rotary_now(void *)
{
    return rotary_on_the_line->now_us;
}

} // namespace ale_test

extern "C" {

struct ale_port {
    bool gone;
};

inline ale_port rotary_port;

int ale_port_open(ale_port_t **out, const char *, int32_t baud)
{
    ale_test::FakeRotary *s = ale_test::rotary_on_the_line;
    *out = nullptr;
    if (!s->plugged()) {
        return ALE_PORT_ABSENT;
    }
    rotary_port = {false};
    *out = &rotary_port;
    s->clear_line();
    s->open = true;
    s->opened++;
    s->port_baud = baud;
    return ALE_PORT_OK;
}

int ale_port_set_baud(ale_port_t *, int32_t baud)
{
    ale_test::rotary_on_the_line->port_baud = baud;
    return ALE_PORT_OK;
}

int ale_port_set_dtr(ale_port_t *, bool on)
{
    ale_test::rotary_on_the_line->dtr = on ? 1 : 0;
    return ALE_PORT_OK;
}

int ale_port_wait(ale_port_t *port, int32_t timeout_ms)
{
    ale_test::FakeRotary *s = ale_test::rotary_on_the_line;
    const int64_t until_us = s->now_us + int64_t{1000} * timeout_ms;
    if (port == nullptr) {
        const bool open = s->open;
        s->open = false; // what is sent to a closed port is lost
        s->pass(until_us);
        s->open = open;
        return 0;
    }
    const bool readable = s->pass(until_us);
    rotary_port.gone = rotary_port.gone || !s->plugged();
    if (rotary_port.gone) {
        return ALE_PORT_GONE;
    }
    return readable ? 1 : 0;
}

int ale_port_read(ale_port_t *, uint8_t *bytes, size_t capacity)
{
    const std::string taken = ale_test::rotary_on_the_line->take(capacity);
    std::copy(taken.begin(), taken.end(), bytes);
    return static_cast<int>(taken.size());
}

int ale_port_write(ale_port_t *, const uint8_t *bytes, size_t count, int32_t)
{
    ale_test::FakeRotary *s = ale_test::rotary_on_the_line;
    if (rotary_port.gone || !s->plugged()) {
        return ALE_PORT_GONE;
    }
    if (s->port_baud == s->sensor_baud) {
        s->hear(std::string(bytes, bytes + count));
    }
    return ALE_PORT_OK;
}

bool ale_port_has_baud(const ale_port_t *)
{
    return ale_test::rotary_on_the_line->is_rs232;
}

void ale_port_close(ale_port_t *)
{
    ale_test::rotary_on_the_line->open = false;
    ale_test::rotary_on_the_line->clear_line();
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
