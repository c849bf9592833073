#include "robot/record/recorder.h"

#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <unistd.h>

namespace record
{

namespace
{

constexpr int step_ms = 10;
constexpr int64_t second_us = 1000000;

int64_t clock_now(void *user)
{
    return ale_clock_now_us(static_cast<const ale_clock_t *>(user));
}

int64_t real_now_us()
{
    const ale_clock_t real = {ALE_CLOCK_REAL, 0};
    return ale_clock_now_us(&real);
}

const char *or_null(const std::string &text)
{
    return text.empty() ? nullptr : text.c_str();
}

} // namespace

Recorder::Recorder(const Options &options)
    : options_(options),
      clock_(ale_clock_start(static_cast<int32_t>(std::lround(options.time_scale * ALE_CLOCK_REAL))))
{
    if (options_.lcm) {
        join_lcm();
    }
    if (ale_recording_create(&recording_, options_.out.c_str()) < 0) {
        throw std::runtime_error(options_.out + ": " + std::strerror(errno));
    }
    recording_open_ = true;
    open_line();
}

Recorder::~Recorder()
{
    scanner_.reset();
    if (recording_open_) {
        ale_recording_close(&recording_);
    }
}

void Recorder::join_lcm()
{
    clocks_.scale_ppm = clock_.scale_ppm;
    char error[ALE_BUS_ERROR];
    bus_.reset(ale_bus_open(or_null(options_.lcm_url), error));
    if (!bus_) {
        throw std::runtime_error(std::string(error) + " (--no-lcm records without odometry)");
    }
    if (ale_bus_on_odometry(bus_.get(), on_odometry, this) < 0) {
        throw std::runtime_error("cannot subscribe to the odometry");
    }
}

void Recorder::open_line()
{
    ale_scanner_config_t config = {};
    config.family = options_.type.c_str();
    config.path = or_null(options_.port);
    config.serial = or_null(options_.serial);
    config.baud = options_.baud;
    config.step_ms = step_ms;
    config.time_scale = options_.time_scale;
    config.tap = on_bytes;
    config.tap_user = this;
    config.now_us = clock_now;
    config.now_user = &clock_;
    config.utime_offset_us = clock_.offset_us;
    scanner_.reset(ale_scanner_open(&config));
    if (!scanner_) {
        throw std::runtime_error("no memory for the scanner's driver");
    }
}

void Recorder::note_write(int result)
{
    if (result < 0 && write_error_ == 0) {
        write_error_ = errno != 0 ? errno : EIO;
    }
}

void Recorder::on_bytes(void *user, bool sent, const uint8_t *bytes, uint32_t count, int64_t host_us)
{
    auto *self = static_cast<Recorder *>(user);
    self->bytes_in_ += sent ? 0 : count;
    self->note_write(ale_recording_write(&self->recording_, sent ? ALE_CHUNK_SENT : ALE_CHUNK_RECEIVED,
                                         host_us, bytes, count));
}

/* Odometry comes in its sender's time; the recording has one clock, that of the bytes. */
void Recorder::on_odometry(void *user, const ale_odometry_t *sample, uint64_t sender)
{
    auto *self = static_cast<Recorder *>(user);
    ale_odometry_t inside = *sample;
    const int64_t now_us = ale_clock_now_us(&self->clock_);
    if (ale_sender_clocks_take(&self->clocks_, sender, ale_clock_from_utime(&self->clock_, sample->stamp_us),
                               now_us, &inside.stamp_us)) {
        self->odometry_++;
        self->note_write(ale_recording_odometry(&self->recording_, now_us, &inside));
    }
}

/* What the driver says, when it is news; numbers once a second where somebody watches. */
void Recorder::tell()
{
    const ale_scanner_health_t *health = ale_scanner_health(scanner_.get());
    const int64_t now_us = real_now_us();
    const bool watched = isatty(STDERR_FILENO) != 0;
    if (status_ != health->status) {
        status_ = health->status;
        std::fprintf(stderr, "%sale-record: %s\n", watched ? "\r\033[K" : "", health->status);
    }
    if (now_us - told_us_ >= second_us) {
        told_us_ = now_us;
        note_write(std::fflush(recording_.file));
        if (watched) {
            std::fprintf(stderr,
                         "\r\033[K%" PRId64 " s  %" PRIu64 " scans  %" PRIu64 " lost  %" PRIu64 " odometry",
                         (now_us - begin_us_) / second_us, health->scans, health->scans_lost, odometry_);
        }
    }
}

bool Recorder::over() const
{
    const int64_t limit_us = options_.seconds * second_us;
    return write_error_ != 0 || (limit_us > 0 && real_now_us() - begin_us_ >= limit_us);
}

void Recorder::run(bool (*stop)())
{
    const auto scan = std::make_unique<ale_scan_t>();
    begin_us_ = real_now_us();
    while (!stop() && !over()) {
        ale_scanner_step(scanner_.get(), scan.get());
        if (bus_) {
            ale_bus_receive(bus_.get(), 0);
        }
        tell();
    }
    if (isatty(STDERR_FILENO) != 0) {
        std::fputc('\n', stderr);
    }
}

void Recorder::finish()
{
    const ale_scanner_health_t health = *ale_scanner_health(scanner_.get());
    scanner_.reset();
    note_write(ale_recording_close(&recording_));
    recording_open_ = false;
    if (write_error_ != 0) {
        throw std::runtime_error(options_.out + ": " + std::strerror(write_error_));
    }
    std::printf("scans %" PRIu64 "\nlost %" PRIu64 "\nbytes %" PRIu64 "\nodometry %" PRIu64 "\n",
                health.scans, health.scans_lost, bytes_in_, odometry_);
    if (health.scans == 0) {
        throw std::runtime_error(std::string("no scan came: ") + health.status);
    }
}

} // namespace record
