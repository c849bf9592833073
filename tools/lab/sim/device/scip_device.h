/* A URG-04LX as seen through its serial line: commands in, replies out, SCIP 1.1 and 2.0. Pure on bytes
 * and times of the caller; no line, no clock, no measurement of its own.
 *
 *   device.receive(bytes, now_us);       what the host sent
 *   device.answer(now_us);               replies that are due by now
 *   device.turn(turn, start_us);         a turn is over: its stream frame, and replies that waited for it
 *
 * Behaves as firmware 3.1.04 does; what the document leaves open is said in README.md. */
#ifndef ALE_LAB_SIM_SCIP_DEVICE_H
#define ALE_LAB_SIM_SCIP_DEVICE_H

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/sim/device/scanner.h"
#include "lab/sim/device/scip_reply.h"

extern "C" {
#include "scanner/urg/scip_request.h"
}

namespace sim
{

enum class Protocol {
    scip1,      /* powers up in SCIP 1.1, can be switched to 2.0 */
    scip1_only, /* firmware before 3.0: knows nothing else */
    scip2       /* powers up in 2.0 */
};

class ScipDevice final : public Device
{
  public:
    struct Options {
        Protocol protocol = Protocol::scip2;
        int64_t command_interval_us = 0;       /* commands are served at most so often */
        std::optional<int64_t> clock_wraps_us; /* the millisecond counter passes 2^24 at this time */
        int64_t utime_zero_us = 0; /* for recordings: the clock of messages at time 0 of now_us, */
        double speed = 1;          /* which runs so much faster than the host's */
    };

    ScipDevice(const Scanner &scanner, const Options &options);

    /* As after the supply came on: default protocol, laser and stream off, clock at 0. */
    void power_up(int64_t now_us) override;
    /* A power-up that comes back in SCIP 1.1. */
    void power_up_in_scip1(int64_t now_us) override;

    void receive(std::string_view bytes, int64_t now_us) override;
    std::vector<Reply> answer(int64_t now_us) override;
    /* When answer() will have something to say by itself; nothing: not before a command or a turn. */
    std::optional<int64_t> answer_due_us() const override;

    /* The turn is over; device_start_us is when it began, on the clock of now_us. */
    std::vector<Reply> turn(const Turn &turn, int64_t device_start_us) override;

    /* The next frame of the stream carries this error status and no data, and the stream is over. */
    void break_stream(const std::string &status) override;

    /* Somebody has asked for ranges since the start. */
    bool wanted(bool /* connected */ = true) const override
    {
        return wanted_;
    }
    bool streaming() const override
    {
        return stream_.has_value();
    }

  private:
    struct Stream {
        ale_scip_request_t request;
        std::string suffix; /* ";string" of the command */
        uint32_t to_skip;
    };
    struct Waiting {
        ale_scip_request_t request;
        std::string echo;
    };

    void boot(int protocol, int64_t now_us);
    uint32_t clock_ms(int64_t at_us) const;
    uint32_t stamp_of(const Turn &turn, int64_t device_start_us) const;
    std::string played() const;
    void set_laser(bool on);
    Reply execute(const std::string &line);
    Reply execute_scip1(const std::string &line);
    Reply execute_scip2(const std::string &line);
    Reply version_scip1(const std::string &line) const;
    Reply switch_laser_scip1(const std::string &line);
    Reply get_scip1(const std::string &line);
    Reply set_baud_scip1(const std::string &line);
    Reply identity(const std::string &echo) const;
    Reply parameters(const std::string &echo) const;
    Reply condition(const std::string &echo) const;
    Reply state(const std::string &echo) const;
    Reply laser_on(const std::string &echo);
    Reply laser_off(const std::string &echo);
    Reply reset(const std::string &echo);
    Reply time_mode(const std::string &echo);
    Reply set_baud(const std::string &echo);
    Reply motor_speed(const std::string &echo) const;
    Reply sensitivity(const std::string &echo) const;
    Reply measure(const std::string &echo);
    std::string range_error(const std::string &command) const;
    Reply last_ranges(const ale_scip_request_t &request, const std::string &echo);
    Reply ranges(const ale_scip_request_t &request, const std::string &echo, const char *status) const;
    Reply stream_frame();

    Scanner scanner_;
    Options options_;
    int protocol_ = 2;
    int32_t baud_ = 19200;
    int64_t clock_origin_us_ = 0;
    int64_t now_us_ = 0; /* of the command that is being executed */
    int64_t laser_since_us_ = 0;
    int64_t next_answer_us_ = 0;
    std::optional<Stream> stream_;
    std::string broken_status_;
    std::optional<Waiting> waiting_; /* a request for the last scan, before there is one */
    std::optional<Turn> last_turn_;  /* measured whole since the laser is on */
    std::string line_;
    std::deque<std::string> commands_;
    uint32_t last_stamp_ = 0;
    bool line_too_long_ = false;
    bool laser_ = false;
    bool time_mode_ = false;
    bool wanted_ = false;
};

} // namespace sim

#endif
