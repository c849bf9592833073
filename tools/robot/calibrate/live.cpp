#include "robot/calibrate/live.h"

#include <ale/odometry_t.hpp>
#include <ale/pose_t.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/command_line/interrupt.h"
#include "common/feed/lcm_feed.h"
#include "robot/calibrate/first_drive.h"

namespace calibrate
{

namespace
{

constexpr int8_t lost = 0;
constexpr int step_ms = 100;
constexpr double look_s = 1;          /* from one judgement to the next */
constexpr size_t most_poses = 200000; /* whoever floods the bus takes no more memory */

double now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void keep(std::vector<TimedPose> &poses, const TimedPose &pose)
{
    const bool is_sound = std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
    if (is_sound && poses.size() < most_poses && (poses.empty() || pose.time > poses.back().time)) {
        poses.push_back(pose);
    }
}

/* Only what changes is said again. */
void tell_missing(const std::string &missing, std::string &said)
{
    if (missing != said && !missing.empty()) {
        std::fprintf(stderr, "still to be driven: %s\n", missing.c_str());
        said = missing;
    }
}

bool tell(const Verdict &verdict)
{
    bool fine = true;
    for (const Finding &finding : verdict.findings) {
        std::printf("%-5s %-8s %s\n", finding.fine ? "fine" : "WRONG", finding.subject.c_str(),
                    finding.words.c_str());
        fine = fine && finding.fine;
    }
    return fine;
}

} // namespace

bool check_first_drive(const std::string &lcm_url, int seconds)
{
    FirstDrive drive;
    feed::LcmFeed feed(lcm_url);
    feed.on<ale::pose_t>("ALE_POSE", [&](const ale::pose_t &pose) {
        if (pose.state != lost && !pose.predicted) {
            keep(drive.seen, {now_s() - pose.age_us * 1e-6, pose.x, pose.y, pose.theta});
        }
    });
    feed.on<ale::odometry_t>("ALE_ODOMETRY", [&](const ale::odometry_t &sample) {
        keep(drive.counted, {now_s(), sample.x, sample.y, sample.theta});
    });
    std::fprintf(stderr,
                 "Drive slowly: about a metre straight ahead, a turn to the left, straight ahead again.\n");
    const double end = now_s() + seconds;
    double next = now_s() + look_s;
    std::string said;
    Verdict verdict = judge(drive);
    while (!verdict.missing.empty() && now_s() < end && !cli::interrupted()) {
        feed.wait(step_ms);
        if (now_s() > next) {
            verdict = judge(drive);
            tell_missing(verdict.missing, said);
            next = now_s() + look_s;
        }
    }
    if (drive.seen.empty()) {
        throw std::runtime_error(
            "no robot is heard that knows its place (ALE_POSE): does ale-slamd run, and is it not lost?");
    }
    if (!verdict.missing.empty() && !drive.counted.empty()) {
        throw std::runtime_error("too little was driven, still missing: " + verdict.missing);
    }
    return tell(verdict);
}

} // namespace calibrate
