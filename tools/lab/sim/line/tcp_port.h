/* A scanner's end of an Ethernet: a TCP port that serves one client at a time. */
#ifndef ALE_LAB_SIM_TCP_PORT_H
#define ALE_LAB_SIM_TCP_PORT_H

#include "lab/sim/line/port.h"

namespace sim
{

class TcpPort final : public Port
{
  public:
    /* Listens on this computer alone; 0: on any free port. Throws std::system_error. */
    explicit TcpPort(int number);
    ~TcpPort() override;

    int number() const
    {
        return number_;
    }
    void unplug() override;
    void plug() override;
    bool plugged() const override
    {
        return listener_ >= 0;
    }
    std::string read() override;
    size_t write(const std::string &bytes, int64_t host_us) override;
    bool connected() const override
    {
        return client_ >= 0;
    }
    bool client_has_to_read() const override;
    void wait(int64_t timeout_us, int other) const override;

  private:
    void accept_client();
    void hang_up();

    int number_;
    int listener_ = -1;
    int client_ = -1;
};

} // namespace sim

#endif
