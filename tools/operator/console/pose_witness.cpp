#include "operator/console/pose_witness.h"

#include <algorithm>
#include <cstddef>

namespace console
{

namespace
{

constexpr size_t most_heard = 512;
constexpr std::chrono::seconds alarm_lasts{10};

/* The robot vouches once a second: a pose of which it knows nothing after so long is not its own. */
constexpr std::chrono::seconds vouched_within{3};

/* Numbers so far behind are not those of poses that were held up. */
constexpr int32_t overtaken_scans = 100;

} // namespace

void PoseWitness::heard(int32_t scan, int64_t digest, Clock::time_point now)
{
    if (heard_.size() == most_heard) {
        heard_.pop_front();
    }
    heard_.push_back({scan, digest, now});
}

PoseWitness::Verdict PoseWitness::judge(const Heard &pose, const ale::vouched_t &vouched,
                                        Clock::time_point now)
{
    const auto &scans = vouched.pose_scan;
    for (size_t k = 0; k < scans.size(); k++) {
        if (scans[k] == pose.scan && vouched.pose_digest[k] == pose.digest) {
            return Verdict::true_one;
        }
    }
    const auto [oldest, newest] = std::minmax_element(scans.begin(), scans.end());
    if (scans.empty() || pose.scan > *newest) {
        return now - pose.when > vouched_within ? Verdict::forged : Verdict::open;
    }
    const bool unknown = pose.scan < *oldest && pose.scan > *oldest - overtaken_scans;
    return unknown ? Verdict::true_one : Verdict::forged;
}

uint64_t PoseWitness::compare(const ale::vouched_t &vouched, Clock::time_point now)
{
    const uint64_t before = forged_;
    std::deque<Heard> open;
    for (const Heard &pose : heard_) {
        const Verdict verdict = judge(pose, vouched, now);
        forged_ += verdict == Verdict::forged;
        if (verdict == Verdict::open) {
            open.push_back(pose);
        }
    }
    heard_ = std::move(open);
    alarm_ = forged_ > before ? now : alarm_;
    return forged_ - before;
}

bool PoseWitness::is_alarmed(Clock::time_point now) const
{
    return forged_ > 0 && now - alarm_ < alarm_lasts;
}

} // namespace console
