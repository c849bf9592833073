// A pipeline on the heap, for tests.
#pragma once

#include <memory>

#include "lib/motion/room.h"

extern "C" {
#include "track/pipeline.h"
}

namespace room
{
struct FreePipeline {
    void operator()(ale_pipeline_t *p) const
    {
        ::operator delete(p);
    }
};
using Pipeline = std::unique_ptr<ale_pipeline_t, FreePipeline>;

inline Pipeline make(const ale_pipeline_config_t &config)
{
    Pipeline p(static_cast<ale_pipeline_t *>(::operator new(ale_pipeline_size())));
    return ale_pipeline_init(p.get(), &config) == 0 ? std::move(p) : nullptr;
}
} // namespace room
