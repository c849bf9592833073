/* The scanner's line and the odometry beside it, on their way into a recording. */
#ifndef RECORD_RECORDER_H
#define RECORD_RECORDER_H

#include <cstdint>
#include <memory>
#include <string>

extern "C" {
#include "lcm/bus.h"
#include "lcm/sender_clocks.h"
#include "realtime/clock.h"
#include "scanner/scanner.h"
#include "store/recording.h"
}

namespace record
{

struct Options {
    std::string type = "urg"; /* family, or auto */
    std::string port;         /* empty: the scanner is looked for */
    std::string serial;       /* empty: any */
    std::string out;
    std::string lcm_url; /* empty: the environment's, else LCM's default */
    bool lcm = true;
    int32_t baud = 0;    /* 0: detect */
    int64_t seconds = 0; /* 0: until somebody says stop */
    double time_scale = 1;
};

class Recorder
{
  public:
    /* Opens LCM, the recording and the line; throws std::runtime_error. */
    explicit Recorder(const Options &options);
    ~Recorder();
    Recorder(const Recorder &) = delete;
    Recorder &operator=(const Recorder &) = delete;

    /* Until the time is over, somebody says stop, or the recording cannot be written. */
    void run(bool (*stop)());

    /* Closes line and recording and prints the counts. Throws std::runtime_error when not all was written, or
     * no scan came. */
    void finish();

  private:
    static void on_bytes(void *user, bool sent, const uint8_t *bytes, uint32_t count, int64_t host_us);
    static void on_odometry(void *user, const ale_odometry_t *sample, uint64_t sender);

    void join_lcm();
    void open_line();
    void note_write(int result);
    void tell();
    bool over() const;

    struct CloseBus {
        void operator()(ale_bus_t *bus) const
        {
            ale_bus_close(bus);
        }
    };
    struct CloseLine {
        void operator()(ale_scanner_t *scanner) const
        {
            ale_scanner_close(scanner);
        }
    };

    Options options_;
    ale_clock_t clock_;
    ale_sender_clocks_t clocks_{};             /* of who sends odometry */
    std::unique_ptr<ale_bus_t, CloseBus> bus_; /* nullptr without LCM */
    ale_recording_t recording_{};
    bool recording_open_ = false;
    std::unique_ptr<ale_scanner_t, CloseLine>
        scanner_;         /* before the recording, which hears of its last bytes */
    int write_error_ = 0; /* errno of the first write that failed */
    uint64_t bytes_in_ = 0;
    uint64_t odometry_ = 0;
    int64_t begin_us_ = 0; /* real time */
    int64_t told_us_ = 0;
    std::string status_; /* last told */
};

} // namespace record

#endif
