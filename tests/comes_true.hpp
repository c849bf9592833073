/* Waits for what another thread does; half a minute is only there to fail when it never comes. */
#ifndef TESTS_COMES_TRUE_HPP
#define TESTS_COMES_TRUE_HPP

#include <chrono>
#include <thread>

template <class Condition> bool comes_true(Condition condition)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition() && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return condition();
}

#endif
