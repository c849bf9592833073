/* Instructions of the running program, under callgrind (--collect-atstart=no --callgrind-out-file=BASE); on
 * ARM the cycles of a Cortex-A7, under qemu-arm with the plugin cortex_a7 (out=BASE). */
#ifndef BENCH_COST_COUNTER_HPP
#define BENCH_COST_COUNTER_HPP

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <unistd.h>

#ifdef __arm__
#include "proofs/wcet/cortex_a7/counting.h"
#else
#include <valgrind/callgrind.h>
#endif

namespace bench
{

/* The counter's own count, read from what it writes when asked. */
class CostCounter
{
  public:
#ifdef __arm__
    static constexpr bool counts_cycles = true;
#else
    static constexpr bool counts_cycles = false;
#endif

    explicit CostCounter(std::string base) : base_(std::move(base))
    {
    }

    /* Whether somebody counts; of the plugin that is known when it is asked for its count. */
    static bool may_be_there()
    {
#ifdef __arm__
        return true;
#else
        return RUNNING_ON_VALGRIND != 0;
#endif
    }

    /* Begins to count, or stops. */
    static void toggle()
    {
        ask(Ask::toggle);
    }

    /* What was counted since the last call; counting stops meanwhile. */
    uint64_t take()
    {
        ask(Ask::write);
        const std::string path = base_ + "." + std::to_string(++dumps_);
        std::ifstream file(path);
        uint64_t count = 0;
        bool found = false;
        for (std::string line; std::getline(file, line);) {
            if (line.rfind("totals: ", 0) == 0) {
                count = std::stoull(line.substr(8));
                found = true;
            }
        }
        unlink(path.c_str());
        if (!found) {
            throw std::runtime_error(path + ": no count (run this by make wcet or make wcet-cycles)");
        }
        return count;
    }

    /* The cost of one call. */
    template <typename Call> uint64_t of(Call call)
    {
        toggle();
        call();
        toggle();
        return take();
    }

  private:
    enum class Ask { toggle, write };

    static void ask(Ask what)
    {
#ifdef __arm__
        syscall(COUNTING_CALL, what == Ask::toggle ? COUNTING_TOGGLES : COUNTING_WRITES);
#else
        if (what == Ask::toggle) {
            CALLGRIND_TOGGLE_COLLECT;
        } else {
            CALLGRIND_DUMP_STATS;
        }
#endif
    }

    std::string base_;
    int dumps_ = 0;
};

} // namespace bench

#endif
