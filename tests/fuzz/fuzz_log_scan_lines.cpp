/* A whole line chooses the format; the next is almost whole, so that its end and what follows are reached. */
#include "read_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const std::string beginning = ale_test::numbers(727) + "\n" + ale_test::numbers(724);
    ale_test::read_log(beginning, data, size);
    return 0;
}
