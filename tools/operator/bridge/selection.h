/* Which channels go over the link, and how often at most. Pure; times come in. */
#ifndef BRIDGE_SELECTION_H
#define BRIDGE_SELECTION_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bridge
{

class Selection
{
  public:
    /* Each "CHANNEL" or "CHANNEL:HZ", 0.001 <= HZ <= 1000. Throws cli::WrongUse saying what is wrong. */
    explicit Selection(const std::vector<std::string> &words);

    bool contains(const std::string &channel) const
    {
        return channels_.count(channel) > 0;
    }

    /* Whether a message of the channel goes out now. What comes evenly is thinned evenly. */
    bool take(const std::string &channel, int64_t now_us);

    std::vector<std::string> names() const;

  private:
    struct Pace {
        int64_t period_us = 0; /* 0: every message */
        int64_t due_us = 0;
    };
    std::map<std::string, Pace> channels_;
};

} // namespace bridge

#endif
