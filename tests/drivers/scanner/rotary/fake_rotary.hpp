// A rotary scanner in virtual time.
#pragma once

#include <string>

#include "drivers/scanner/fake_port.hpp"

namespace ale_test
{

class FakeRotary : public FakeDevice
{
  public:
    int32_t sensor_baud = 230400;

    void hear(const std::string &) override
    {
    }

  protected:
    // What it says by now.
    virtual void go_on() = 0;
    virtual void power_up()
    {
    }
    void live() final
    {
        if (!was_plugged_ && plugged()) {
            power_up();
        }
        was_plugged_ = plugged();
        go_on();
    }
    void say(const std::string &bytes)
    {
        if (open && !silent() && plugged()) {
            output_ += port_baud == sensor_baud ? bytes : std::string(bytes.size() / 2, '\xfe');
        }
    }

  private:
    bool was_plugged_ = true;
};

} // namespace ale_test
