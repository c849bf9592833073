/* Records what the console hears, for as long as somebody wants it.
 *
 *   recorder.start();                              any thread; throws std::runtime_error in words
 *   recorder.take("ALE_POSE", bytes, count);       LCM thread: never waits for the disk
 *   recorder.stop();                               what waits is written
 *
 * Between them and the disk lie a queue of bounded size and a thread: what does not fit is dropped and
 * counted. When the disk takes no more the recording ends, whole up to there, and says why. */
#ifndef CONSOLE_RECORDER_H
#define CONSOLE_RECORDER_H

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "operator/console/recordings/event_file.h"
#include "operator/console/recordings/preface.h"
#include "operator/console/recordings/shelf.h"

namespace console
{

/* What a page is told of it. */
struct RecorderState {
    std::string name; /* of the recording that is made; empty: none */
    int64_t begun_ms = 0;
    uint64_t messages = 0; /* written */
    uint64_t bytes = 0;
    uint64_t dropped = 0;
    std::string trouble; /* why the last one ended by itself */
};

class Recorder
{
  public:
    static constexpr size_t most_waiting_bytes = size_t{8} << 20;
    static constexpr uint64_t usually_kept_free = uint64_t{32} << 20;

    /* shelf: for recordings; it must outlive this. keep_free: the disk is never filled but for so many bytes.
     */
    explicit Recorder(const Shelf &shelf, uint64_t keep_free = usually_kept_free);
    ~Recorder();
    Recorder(const Recorder &) = delete;
    Recorder &operator=(const Recorder &) = delete;

    /* Nothing when it records already. start and stop: one thread at a time. */
    void start();
    void stop();

    void take(const char *channel, const uint8_t *bytes, size_t count);

    RecorderState state() const;

  private:
    struct Heard {
        int64_t received_us;
        std::string channel;
        std::vector<uint8_t> bytes;
    };

    void write_all();
    bool write(const std::vector<Heard> &batch);
    std::string trouble_of(int error) const;
    uint64_t free_bytes() const;
    uint64_t room_bytes() const;
    std::string new_name() const;

    const Shelf &shelf_;
    const uint64_t keep_free_;
    std::unique_ptr<EventWriter> file_; /* of the writing thread, while there is one */
    std::thread thread_;

    std::atomic<bool> records_{false};
    mutable std::mutex mutex_;
    std::condition_variable something_;
    bool ending_ = false;
    Preface preface_;
    std::vector<Heard> waiting_;
    size_t waiting_bytes_ = 0;
    RecorderState state_;
};

} // namespace console

#endif
