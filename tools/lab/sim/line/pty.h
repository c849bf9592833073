/* A serial line: a pseudo terminal whose other end is reached by a stable link. A client that is slow misses
 * whole frames (see Line). */
#ifndef ALE_LAB_SIM_PTY_H
#define ALE_LAB_SIM_PTY_H

#include <cstdint>
#include <string>

#include "lab/sim/line/port.h"

namespace sim
{

class Pty final : public Port
{
  public:
    /* Opens a new pseudo terminal and points the link at it, replacing an old link in one step. Throws
     * std::runtime_error when that is not possible. */
    explicit Pty(std::string link);
    ~Pty() override;

    /* Pulls the plug: the client's end hangs up, the link is removed. */
    void unplug() override;
    /* Another pseudo terminal takes its place, perhaps with another number. */
    void plug() override;
    bool plugged() const override
    {
        return master_ >= 0;
    }

    std::string read() override;
    size_t write(const std::string &bytes, int64_t host_us) override;
    bool connected() const override;
    bool client_has_to_read() const override;
    int32_t rate() const override;
    void wait(int64_t timeout_us, int other) const override;

  private:
    bool make_raw(int64_t host_us);

    std::string link_;
    std::string path_;
    int master_ = -1;
    int64_t cooked_since_us_ = -1;
};

} // namespace sim

#endif
