/* Waits for what another thread does; the time is only there to fail when it never comes. */
#ifndef TESTS_COMES_TRUE_HPP
#define TESTS_COMES_TRUE_HPP

#include <chrono>
#include <thread>

template <class Condition> bool comes_true(Condition condition)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

#endif
