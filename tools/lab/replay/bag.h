/* Bags of ROS 1 and ROS 2, and MCAP: turned into an LCM log by ale-foxglove, which reads them without ROS
 * (Python, PyPI's rosbags).
 *
 *   const LogFile file(path);
 *   LogReader log(file.path());           the log itself, or what became of the bag; gone with `file` */
#ifndef ALE_LAB_REPLAY_BAG_H
#define ALE_LAB_REPLAY_BAG_H

#include <string>

namespace ale
{

/* By content: a folder with metadata.yaml, "#ROSBAG V2.0", or MCAP's magic. */
bool is_bag(const std::string &path);

class LogFile
{
  public:
    /* Throws std::runtime_error with what ale-foxglove says, or where it was looked for. */
    explicit LogFile(const std::string &path);
    ~LogFile();
    LogFile(const LogFile &) = delete;
    LogFile &operator=(const LogFile &) = delete;

    const std::string &path() const
    {
        return folder_.empty() ? given_ : converted_;
    }

  private:
    void convert();

    std::string given_;
    std::string folder_;
    std::string converted_;
};

} // namespace ale

#endif
