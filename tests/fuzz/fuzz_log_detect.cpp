/* Any bytes at all: the choice of the format, gzip included. */
#include "read_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ale_test::read_log("", data, size);
    return 0;
}
