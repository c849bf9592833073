/* Replies of a SCIP device as strings, put together by the writer of drivers/scanner/urg. */
#ifndef ALE_LAB_SIM_SCIP_REPLY_H
#define ALE_LAB_SIM_SCIP_REPLY_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/sim/device/device.h"

extern "C" {
#include "scanner/urg/scip_encode.h"
}

namespace sim
{

/* A line without the ";string" that only asks to be echoed, and what follows the symbol of a command of
 * SCIP 2.0. */
inline std::string scip_command(const std::string &line)
{
    return line.substr(0, line.find(';'));
}

inline std::string scip_parameter(const std::string &line)
{
    return scip_command(line).substr(2);
}

class ReplyWriter
{
  public:
    ReplyWriter(const std::string &echo, const std::string &status)
    {
        ale_scip_put_echo(&writer_, echo.c_str());
        ale_scip_put_status(&writer_, status.c_str());
    }
    ReplyWriter(const ReplyWriter &) = delete;
    ReplyWriter &operator=(const ReplyWriter &) = delete;

    ReplyWriter &info(const char *key, const std::string &value)
    {
        ale_scip_put_info(&writer_, key, value.c_str());
        return *this;
    }
    ReplyWriter &info(const char *key, int32_t value)
    {
        return info(key, std::to_string(value));
    }
    ReplyWriter &plain(const std::string &text)
    {
        ale_scip_put_plain(&writer_, text.c_str());
        return *this;
    }
    ReplyWriter &summed(const std::string &text)
    {
        ale_scip_put_status(&writer_, text.c_str());
        return *this;
    }
    ReplyWriter &stamp(uint32_t stamp_ms)
    {
        ale_scip_put_stamp(&writer_, stamp_ms);
        return *this;
    }
    ReplyWriter &values(int protocol, const std::vector<int32_t> &values, unsigned characters)
    {
        ale_scip_put_values(&writer_, protocol, values.data(), static_cast<uint32_t>(values.size()),
                            characters);
        return *this;
    }
    /* The whole reply; turn_start_us says whose ranges it holds. */
    Reply reply(std::optional<int64_t> turn_start_us = std::nullopt)
    {
        ale_scip_put_end(&writer_);
        return {{bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(writer_.used)},
                turn_start_us,
                turn_start_us.has_value()};
    }

  private:
    /* Every step of the finest scanner in three characters, with sums and line ends. */
    std::array<uint8_t, 16384> bytes_ = {};
    ale_scip_writer_t writer_ = {bytes_.data(), bytes_.size(), 0, false};
};

/* A reply without lines. */
inline Reply short_reply(const std::string &echo, const std::string &status)
{
    return ReplyWriter(echo, status).reply();
}

} // namespace sim

#endif
