/* Work that may wait for a disk, away from the thread that serves the pages: STOP goes through that one.
 *
 *   errands.run([=] { Contents found = archive.maps(); return [=] { tell(found); }; });
 *   for (const auto &done : errands.done()) done();       (the serving thread, when woken)
 *
 * One errand after the other, on a thread of their own. */
#ifndef CONSOLE_ERRANDS_H
#define CONSOLE_ERRANDS_H

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace console
{

class Errands
{
  public:
    using Done = std::function<void()>;
    using Errand = std::function<Done()>;

    static constexpr size_t most_waiting = 128;

    /* wake: called on the errands' thread when one is done; it must only wake somebody. */
    explicit Errands(std::function<void()> wake);
    /* Waits for the one that is under way; others are left undone. */
    ~Errands();
    Errands(const Errands &) = delete;
    Errands &operator=(const Errands &) = delete;

    /* False: too many wait already. An errand must not throw. */
    bool run(Errand errand);

    /* What is to be done with what has come of those that are over, in their order. */
    std::vector<Done> done();

  private:
    void work();

    std::function<void()> wake_;
    std::mutex mutex_;
    std::condition_variable something_;
    bool ending_ = false;
    std::deque<Errand> waiting_;
    std::vector<Done> done_;
    std::thread thread_;
};

} // namespace console

#endif
