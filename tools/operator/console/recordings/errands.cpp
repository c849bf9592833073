#include "operator/console/recordings/errands.h"

#include <utility>

namespace console
{

Errands::Errands(std::function<void()> wake) : wake_(std::move(wake)), thread_([this] { work(); })
{
}

Errands::~Errands()
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ending_ = true;
    }
    something_.notify_one();
    thread_.join();
}

bool Errands::run(Errand errand)
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (waiting_.size() >= most_waiting) {
            return false;
        }
        waiting_.push_back(std::move(errand));
    }
    something_.notify_one();
    return true;
}

std::vector<Errands::Done> Errands::done()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(done_, {});
}

void Errands::work()
{
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ending_) {
        if (waiting_.empty()) {
            something_.wait(lock);
            continue;
        }
        const Errand errand = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        Done done = errand();
        lock.lock();
        done_.push_back(std::move(done));
        lock.unlock();
        wake_();
        lock.lock();
    }
}

} // namespace console
