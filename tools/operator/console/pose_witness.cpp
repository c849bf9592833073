#include "operator/console/pose_witness.h"

#include <algorithm>
#include <cstddef>
#include <utility>

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

/* What the robot may be ahead of what is expected of it: words and poses are not held up alike. */
constexpr double margin_scans = 3;
constexpr double forgotten_scans = 50; /* behind: it has stood still meanwhile */
constexpr double followed = 0.1;
constexpr double ppm = 1e6;

} // namespace

void PoseWitness::heard(int32_t scan, int64_t digest, Clock::time_point now)
{
    if (heard_.size() == most_heard) {
        crowded_out_ += now - heard_.front().when < vouched_within;
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

double PoseWitness::expected(Clock::time_point now) const
{
    return reached_ + rate_hz_ * std::chrono::duration<double>(now - reached_at_).count();
}

void PoseWitness::note_reached(const ale::vouched_t &vouched, Clock::time_point now)
{
    if (vouched.pose_scan.empty()) {
        return;
    }
    const double newest = *std::max_element(vouched.pose_scan.begin(), vouched.pose_scan.end());
    const double ahead = expected(now) - newest;
    const bool late = rate_hz_ > 0 && ahead > 0 && ahead < forgotten_scans;
    reached_ = late ? newest + (1 - followed) * ahead : newest;
    reached_at_ = now;
    rate_hz_ = static_cast<double>(vouched.status.scan_rate_hz) * vouched.clock_ppm / ppm;
}

bool PoseWitness::is_beyond(int32_t scan, Clock::time_point now) const
{
    return is_alarmed(now) && rate_hz_ > 0 && scan > expected(now) + margin_scans;
}

uint64_t PoseWitness::compare(const ale::vouched_t &vouched, Clock::time_point now)
{
    const uint64_t before = forged_;
    forged_ += std::exchange(crowded_out_, 0);
    note_reached(vouched, now);
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
