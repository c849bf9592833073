/* Replies of a SCIP device as strings, put together by the writer of drivers/urg. */
#ifndef ALE_SIM_SCIP_REPLY_H
#define ALE_SIM_SCIP_REPLY_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

extern "C" {
#include "urg/scip_encode.h"
}

namespace sim
{

class ScipReply
{
  public:
    ScipReply(const std::string &echo, const std::string &status)
    {
        ale_scip_put_echo(&writer_, echo.c_str());
        ale_scip_put_status(&writer_, status.c_str());
    }
    ScipReply(const ScipReply &) = delete;
    ScipReply &operator=(const ScipReply &) = delete;

    ScipReply &info(const char *key, const std::string &value)
    {
        ale_scip_put_info(&writer_, key, value.c_str());
        return *this;
    }
    ScipReply &info(const char *key, int32_t value)
    {
        return info(key, std::to_string(value));
    }
    ScipReply &plain(const std::string &text)
    {
        ale_scip_put_plain(&writer_, text.c_str());
        return *this;
    }
    ScipReply &stamp(uint32_t stamp_ms)
    {
        ale_scip_put_stamp(&writer_, stamp_ms);
        return *this;
    }
    ScipReply &values(int protocol, const std::vector<int32_t> &values, unsigned characters)
    {
        ale_scip_put_values(&writer_, protocol, values.data(), static_cast<uint32_t>(values.size()),
                            characters);
        return *this;
    }
    std::string end()
    {
        ale_scip_put_end(&writer_);
        return {bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(writer_.used)};
    }

  private:
    /* Every step of the finest scanner in three characters, with sums and line ends. */
    std::array<uint8_t, 16384> bytes_ = {};
    ale_scip_writer_t writer_ = {bytes_.data(), bytes_.size(), 0, false};
};

/* A reply without lines. */
inline std::string short_reply(const std::string &echo, const std::string &status)
{
    return ScipReply(echo, status).end();
}

} // namespace sim

#endif
