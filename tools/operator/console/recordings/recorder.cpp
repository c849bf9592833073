#include "operator/console/recordings/recorder.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <utility>

#include <sys/statvfs.h>

namespace console
{

namespace
{

constexpr uint64_t least_room = uint64_t{1} << 16; /* for less it is not worth while to begin */
constexpr int most_of_a_second = 99;               /* recordings that begin in the same one */

int64_t now_us()
{
    using namespace std::chrono;
    return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

std::string megabytes(uint64_t bytes)
{
    return std::to_string(bytes >> 20) + " MB";
}

} // namespace

Recorder::Recorder(const Shelf &shelf, uint64_t keep_free) : shelf_(shelf), keep_free_(keep_free)
{
}

Recorder::~Recorder()
{
    stop();
}

uint64_t Recorder::free_bytes() const
{
    struct statvfs disk;
    return statvfs(shelf_.folder().c_str(), &disk) == 0 ? uint64_t{disk.f_bavail} * disk.f_frsize
                                                        : UINT64_MAX;
}

/* What may be written. */
uint64_t Recorder::room_bytes() const
{
    const uint64_t free = free_bytes();
    return free > keep_free_ ? free - keep_free_ : 0;
}

/* By this computer's clock on the wall. */
std::string Recorder::new_name() const
{
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 32> stem{};
    std::strftime(stem.data(), stem.size(), "%Y-%m-%d-%H%M%S", &local);
    std::string name = std::string(stem.data()) + ".lcm";
    for (int k = 2; k <= most_of_a_second && shelf_.open(name).number() >= 0; k++) {
        name = std::string(stem.data()) + "-" + std::to_string(k) + ".lcm";
    }
    return name;
}

void Recorder::start()
{
    if (records_) {
        return;
    }
    stop(); /* the thread of one that ended by itself */
    if (!shelf_.is_there()) {
        throw std::runtime_error("there is no folder for recordings (ale-console --recordings DIR)");
    }
    if (room_bytes() < least_room) {
        throw std::runtime_error("the disk of " + shelf_.folder() + " is full: " + megabytes(free_bytes()) +
                                 " are left, and " + megabytes(keep_free_) + " are kept free");
    }
    const std::string name = new_name();
    file_ = std::make_unique<EventWriter>(shelf_.make(name));
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ending_ = false;
        state_ = RecorderState();
        state_.name = name;
        state_.begun_ms = now_us() / 1000;
        for (Preface::Message &message : preface_.messages()) {
            waiting_bytes_ += message.bytes.size() + sizeof(Heard);
            waiting_.push_back({now_us(), std::move(message.channel), std::move(message.bytes)});
        }
    }
    thread_ = std::thread([this] { write_all(); });
    records_ = true;
}

void Recorder::stop()
{
    records_ = false;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ending_ = true;
    }
    something_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    }
    file_.reset();
}

void Recorder::take(const char *channel, const uint8_t *bytes, size_t count)
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        preface_.take(channel, bytes, count);
        if (!records_) {
            return;
        }
        const size_t cost = count + sizeof(Heard);
        if (waiting_bytes_ + cost > most_waiting_bytes) {
            state_.dropped++;
            return;
        }
        waiting_bytes_ += cost;
        waiting_.push_back({now_us(), channel, {bytes, bytes + count}});
    }
    something_.notify_one();
}

RecorderState Recorder::state() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_;
}

/* What the recording thread does until it is to end, or the disk takes no more. */
void Recorder::write_all()
{
    bool goes_on = true;
    while (goes_on) {
        std::vector<Heard> batch;
        {
            std::unique_lock<std::mutex> lock(mutex_);
            something_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
            goes_on = !ending_;
            batch.swap(waiting_);
            waiting_bytes_ = 0;
        }
        goes_on = write(batch) && goes_on;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    records_ = false;
    state_.name.clear();
    state_.dropped += waiting_.size();
    waiting_.clear();
    waiting_bytes_ = 0;
}

bool Recorder::write(const std::vector<Heard> &batch)
{
    const uint64_t before = file_->events();
    const uint64_t room = room_bytes();
    auto heard = batch.begin();
    for (; heard != batch.end() && file_->with(heard->channel, heard->bytes.size()) <= room; ++heard) {
        file_->put(heard->received_us, heard->channel, heard->bytes.data(), heard->bytes.size());
    }
    const int error = heard != batch.end() ? ENOSPC : 0;
    const int failed = file_->flush();
    const uint64_t written = file_->events() - before;
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.messages = file_->events();
    state_.bytes = file_->bytes();
    state_.dropped += batch.size() - written;
    if (failed != 0 || error != 0) {
        state_.trouble = trouble_of(failed != 0 ? failed : error);
    }
    return failed == 0 && error == 0;
}

std::string Recorder::trouble_of(int error) const
{
    const std::string why =
        error == ENOSPC ? "the disk of " + shelf_.folder() + " is full (" + megabytes(free_bytes()) + " left)"
                        : shelf_.folder() + ": " + std::strerror(error);
    return "the recording " + state_.name + " has ended: " + why + "; what came before is in it";
}

} // namespace console
