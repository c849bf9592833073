#include "read_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ale_test::read_log("ODOM 0 0 0 0 0 0 0 host 0\n", data, size);
    return 0;
}
