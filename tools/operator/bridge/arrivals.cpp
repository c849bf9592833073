#include "operator/bridge/arrivals.h"

namespace bridge
{

namespace
{

/* Sequences wrap. */
bool is_after(uint32_t a, uint32_t b)
{
    return static_cast<int32_t>(a - b) > 0;
}

} // namespace

void Arrivals::start_session(const Frame &frame)
{
    any_ = true;
    session_ = frame.session;
    newest_ = frame.sequence - 1;
    newest_of_.clear();
}

bool Arrivals::take(const Frame &frame)
{
    if (!any_ || frame.session != session_) {
        start_session(frame);
    }
    const auto known = newest_of_.find(frame.channel);
    if (known != newest_of_.end() && !is_after(frame.sequence, known->second)) {
        late_++;
        return false;
    }
    newest_of_[frame.channel] = frame.sequence;
    if (is_after(frame.sequence, newest_)) {
        expected_ += frame.sequence - newest_;
        newest_ = frame.sequence;
    }
    received_++;
    return true;
}

} // namespace bridge
