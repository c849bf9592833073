/* --timing: thread CPU time of the stages of every scan as CSV. */
#ifndef ALE_LAB_REPLAY_TIMING_FILE_H
#define ALE_LAB_REPLAY_TIMING_FILE_H

#include "common/export/text_file.h"
#include "common/offline/stage_clock.h"

namespace ale
{

class TimingFile
{
  public:
    explicit TimingFile(const std::string &path);
    void put(uint32_t scan, const StageClock &clock);
    void close()
    {
        file_.close();
    }

  private:
    TextFile file_;
};

} // namespace ale

#endif
