#include "lab/replay/timing_file.h"

namespace ale
{

TimingFile::TimingFile(const std::string &path) : file_(path)
{
    file_.put("scan,deskew_ns,smooth_ns,extract_ns,match_ns,map_ns,total_ns\n");
}

void TimingFile::put(uint32_t scan, const StageClock &clock)
{
    file_.put_integer(scan);
    for (int stage = 0; stage < ALE_STAGES; stage++) {
        file_.put(",").put_integer(clock.stage_ns(static_cast<ale_stage_t>(stage)));
    }
    file_.put(",").put_integer(clock.total_ns()).put("\n");
}

} // namespace ale
