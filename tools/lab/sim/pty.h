/* The device's side of a serial line: a pseudo terminal whose other end is reached by a stable link.
 *
 * As on a real line, bytes that are sent while nobody has the port open are gone. A client that is slow
 * misses whole frames (see Line). */
#ifndef ALE_LAB_SIM_PTY_H
#define ALE_LAB_SIM_PTY_H

#include <cstdint>
#include <string>

namespace sim
{

class Pty
{
  public:
    /* Opens a new pseudo terminal and points the link at it, replacing an old link in one step. Throws
     * std::runtime_error when that is not possible. */
    explicit Pty(std::string link);
    ~Pty();
    Pty(const Pty &) = delete;
    Pty &operator=(const Pty &) = delete;

    /* Pulls the plug: the client's end hangs up, the link is removed. */
    void unplug();
    /* Another pseudo terminal takes its place, perhaps with another number. */
    void plug();
    bool plugged() const
    {
        return master_ >= 0;
    }

    /* What the client has sent by now. */
    std::string read();
    /* Sends as much as the line takes; returns how many bytes that was. All, when nobody listens. */
    size_t write(const std::string &bytes, int64_t host_us);

    /* True while a client has the port open. */
    bool connected() const;
    /* Whether bytes wait for a client that has the port open; false where it lets nobody else look. */
    bool client_has_to_read() const;
    /* Waits until the client sends something, or until `other` (a descriptor, or -1) is readable, at most so
     * long. */
    void wait(int64_t timeout_us, int other) const;

  private:
    bool make_raw(int64_t host_us);

    std::string link_;
    std::string path_;
    int master_ = -1;
    int64_t cooked_since_us_ = -1;
};

} // namespace sim

#endif
