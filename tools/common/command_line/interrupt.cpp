#include "common/command_line/interrupt.h"

#include <atomic>
#include <csignal>

namespace cli
{

namespace
{

std::atomic<bool> came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

} // namespace

void catch_interrupts()
{
    struct sigaction action = {};
    action.sa_handler = [](int) { came = true; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupted()
{
    return came;
}

} // namespace cli
