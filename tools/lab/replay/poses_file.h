/* --poses: both poses, covariance and state at every scan, one JSON object a line. */
#ifndef ALE_LAB_REPLAY_POSES_FILE_H
#define ALE_LAB_REPLAY_POSES_FILE_H

#include "common/export/text_file.h"

extern "C" {
#include "track/pipeline.h"
}

namespace ale
{

class PosesFile
{
  public:
    explicit PosesFile(const std::string &path) : file_(path)
    {
    }
    void put(const ale_estimate_t &estimate);
    void close()
    {
        file_.close();
    }

  private:
    void put_pose(const ale_pose_t &pose, const char *prefix);
    void put_covariance(const int64_t (&cov)[9]);
    void put_information(const int64_t (&information)[6]);

    TextFile file_;
};

} // namespace ale

#endif
