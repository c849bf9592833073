/* Memory that can run out for C++ in all threads but the test's own. For one file of a program: it replaces
 * operator new. */
#ifndef TESTS_SCARCE_MEMORY_HPP
#define TESTS_SCARCE_MEMORY_HPP

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

namespace scarce_memory
{

inline std::atomic<bool> none_left{false};
inline std::atomic<int> refused{0};
inline const std::thread::id test_thread = std::this_thread::get_id();

} // namespace scarce_memory

void *operator new(std::size_t bytes, const std::nothrow_t &) noexcept
{
    using namespace scarce_memory;
    if (none_left && std::this_thread::get_id() != test_thread) {
        refused++;
        return nullptr;
    }
    return std::malloc(bytes > 0 ? bytes : 1);
}

void *operator new(std::size_t bytes)
{
    void *memory = ::operator new(bytes, std::nothrow);
    if (!memory) {
        throw std::bad_alloc();
    }
    return memory;
}

void operator delete(void *memory) noexcept
{
    std::free(memory);
}

void operator delete(void *memory, std::size_t) noexcept
{
    std::free(memory);
}

#endif
