/* A release of the real-time port that goes with its owner. */
#ifndef TESTS_FIRMWARE_REALTIME_RELEASE_HPP
#define TESTS_FIRMWARE_REALTIME_RELEASE_HPP

#include <memory>

extern "C" {
#include "realtime/rt.h"
}

using Release = std::unique_ptr<ale_rt_release_t, decltype(&ale_rt_release_destroy)>;

inline Release make_release()
{
    return {ale_rt_release_create(), ale_rt_release_destroy};
}

#endif
