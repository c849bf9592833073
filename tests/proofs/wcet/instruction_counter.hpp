/* Instructions of the running program, under callgrind (--collect-atstart=no --callgrind-out-file=BASE). */
#ifndef BENCH_INSTRUCTION_COUNTER_HPP
#define BENCH_INSTRUCTION_COUNTER_HPP

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <unistd.h>

#include <valgrind/callgrind.h>

namespace bench
{

/* Callgrind's own count, read from what it writes when asked. */
class InstructionCounter
{
  public:
    explicit InstructionCounter(std::string base) : base_(std::move(base))
    {
    }

    /* Instructions since the last call; counting stops meanwhile. */
    uint64_t take()
    {
        CALLGRIND_DUMP_STATS;
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
            throw std::runtime_error(path + ": no count (run this under callgrind: make wcet)");
        }
        return count;
    }

    /* Instructions of one call. */
    template <typename Call> uint64_t of(Call call)
    {
        CALLGRIND_TOGGLE_COLLECT;
        call();
        CALLGRIND_TOGGLE_COLLECT;
        return take();
    }

  private:
    std::string base_;
    int dumps_ = 0;
};

} // namespace bench

#endif
