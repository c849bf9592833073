/* The device's end of a line: a pseudo terminal (pty.h) or a TCP port (tcp_port.h). As on a real line, bytes
 * that are sent while nobody listens are gone. */
#ifndef ALE_LAB_SIM_PORT_H
#define ALE_LAB_SIM_PORT_H

#include <cstddef>
#include <cstdint>
#include <string>

namespace sim
{

class Port
{
  public:
    Port() = default;
    Port(const Port &) = delete;
    Port &operator=(const Port &) = delete;
    virtual ~Port() = default;

    /* Pulls the plug: whoever is connected hangs up, nobody can connect. */
    virtual void unplug() = 0;
    virtual void plug() = 0;
    virtual bool plugged() const = 0;

    /* What the client has sent by now. */
    virtual std::string read() = 0;
    /* Sends as much as the line takes; returns how many bytes that was. All, when nobody listens. */
    virtual size_t write(const std::string &bytes, int64_t host_us) = 0;

    /* True while a client is there. */
    virtual bool connected() const = 0;
    /* Whether bytes wait for a client; false where it lets nobody else look. */
    virtual bool client_has_to_read() const = 0;
    /* The rate that the client has chosen, bit/s; 0: this line has none. */
    virtual int32_t rate() const
    {
        return 0;
    }
    /* Waits until the client sends something, or until `other` (a descriptor, or -1) is readable, at most so
     * long. */
    virtual void wait(int64_t timeout_us, int other) const = 0;
};

} // namespace sim

#endif
