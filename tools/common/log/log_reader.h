/* A log as a C++ object: opens or throws std::runtime_error with the one-line reason. */
#ifndef ALE_COMMON_LOG_LOG_READER_H
#define ALE_COMMON_LOG_LOG_READER_H

#include <memory>
#include <stdexcept>
#include <string>

extern "C" {
#include "log/log.h"
}

namespace ale
{

class LogReader
{
  public:
    explicit LogReader(const std::string &path)
    {
        ale_log_t *log = nullptr;
        ale_log_error_t error;
        if (ale_log_open(&log, path.c_str(), &error) < 0) {
            throw std::runtime_error(error.message);
        }
        log_.reset(log);
    }
    bool next(ale_log_event_t &event)
    {
        return ale_log_next(log_.get(), &event) > 0;
    }
    const ale_log_info_t &info() const
    {
        return *ale_log_info(log_.get());
    }
    ale_log_statistics_t statistics() const
    {
        return ale_log_statistics(log_.get());
    }
    std::string last_error() const
    {
        return ale_log_last_error(log_.get());
    }

  private:
    struct Close {
        void operator()(ale_log_t *log) const
        {
            ale_log_close(log);
        }
    };
    std::unique_ptr<ale_log_t, Close> log_;
};

} // namespace ale

#endif
