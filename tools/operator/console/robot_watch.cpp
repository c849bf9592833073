#include "operator/console/robot_watch.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/feed/checks.h"
#include "operator/console/messages.h"

extern "C" {
#include "command/vouched.h"
}

namespace console
{

namespace
{

/* A pose that moves farther between two scans was relocated, not driven. */
constexpr float jump_m = 0.5F;

/* A scan number this far back is a new start; one less far was overtaken on its way. */
constexpr int32_t overtaken_scans = 10;

/* Scan numbers run on over a gap of this size at most; beyond, somebody else is talking. */
constexpr int32_t largest_gap = 100000;

} // namespace

void RobotWatch::subscribe(feed::LcmFeed &feed)
{
    feed.on_bytes("ALE_POSE", [this](const uint8_t *bytes, size_t count) { pose_bytes(bytes, count); });
    feed.on_bytes("ALE_VOUCHED", [this](const uint8_t *bytes, size_t count) { vouched_bytes(bytes, count); });
    feed.on<ale::tracking_t>("ALE_TRACKING", [this](const ale::tracking_t &message) { tracking(message); });
    feed.on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &message) { features(message); });
    feed.on<ale::scan_t>("ALE_SCAN", [this](const ale::scan_t &message) { scan(message); });
    feed.on<ale::map_t>("ALE_MAP", [this](const ale::map_t &message) { map(message); });
    feed.on<ale::map_pieces_t>("ALE_MAP_PIECES",
                               [this](const ale::map_pieces_t &message) { map_pieces(message); });
    feed.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) { status(message); });
}

void RobotWatch::restarted()
{
    board_.clear();
    map_parts_ = feed::MapParts();
    map_pieces_ = feed::MapPieces();
    window_ = WindowWatch();
    last_pose_.reset();
    restart_known_ = true;
}

void RobotWatch::pose_bytes(const uint8_t *bytes, size_t count)
{
    ale::pose_t message;
    feed::require(message.decode(bytes, 0, static_cast<int>(count)) >= 0, "truncated, or of another type");
    const PoseWitness::Clock::time_point now = PoseWitness::Clock::now();
    if (commander_.believes()) {
        feed::check(message);
        witness_.heard(message.scan, ale_digest(bytes, count), now);
    }
    if (!witness_.is_beyond(message.scan, now)) {
        pose(message);
    }
}

void RobotWatch::pose(const ale::pose_t &pose)
{
    feed::check(pose);
    if (last_pose_ && pose.scan <= last_pose_->scan) {
        /* Where a robot vouches for its starts a pose tells of none. */
        if (pose.scan > last_pose_->scan - overtaken_scans || commander_.believes()) {
            return;
        }
        restarted();
    }
    const int64_t gap = last_pose_ ? static_cast<int64_t>(pose.scan) - last_pose_->scan - 1 : 0;
    feed::require(gap <= largest_gap, "scan number out of all proportion");
    extend_trail(pose);
    board_.note_pose(Board::Clock::now(), static_cast<uint64_t>(gap));
    board_.pin(Topic::pose, pose_message(pose));
    last_pose_ = pose;
}

void RobotWatch::extend_trail(const ale::pose_t &pose)
{
    const bool jumped =
        last_pose_ && std::hypot(pose.map_x - last_pose_->map_x, pose.map_y - last_pose_->map_y) > jump_m;
    board_.extend_trail({pose.map_x, pose.map_y, jumped || !last_pose_});
}

void RobotWatch::tracking(const ale::tracking_t &tracking)
{
    feed::check(tracking);
    board_.pin(Topic::tracking, tracking_message(tracking));
}

void RobotWatch::features(const ale::features_t &features)
{
    feed::check(features);
    board_.pin(Topic::features, features_message(features));
}

void RobotWatch::scan(const ale::scan_t &scan)
{
    feed::check(scan);
    if (last_pose_) {
        window_.scan(scan, static_cast<double>(last_pose_->theta));
    }
    board_.pin(Topic::scan, scan_message(scan, window_.stain()));
}

void RobotWatch::map(const ale::map_t &part)
{
    feed::check(part);
    if (map_parts_.add(part)) {
        board_.pin(Topic::map, map_message(map_parts_.whole(), map_pieces_));
    }
}

/* They come before the map that they are of; where they were overtaken, or come again because a part was
 * lost, the map that is shown already is told anew. */
void RobotWatch::map_pieces(const ale::map_pieces_t &part)
{
    feed::check(part);
    if (map_pieces_.add(part) && part.version == map_parts_.whole().version) {
        board_.pin(Topic::map, map_message(map_parts_.whole(), map_pieces_));
    }
}

void RobotWatch::status(const ale::status_t &status)
{
    if (commander_.saw(status)) {
        show(status, false);
    }
}

/* After a forged pose the next one counts whatever its number: the true ones are mostly behind it. */
void RobotWatch::vouched_bytes(const uint8_t *bytes, size_t count)
{
    const auto message = commander_.saw_vouched(bytes, count);
    if (!message) {
        return;
    }
    if (boot_ && *boot_ != message->boot) {
        witness_ = PoseWitness();
    }
    if (witness_.compare(*message, PoseWitness::Clock::now()) > 0) {
        last_pose_.reset();
    }
    show(message->status, true);
}

void RobotWatch::show(const ale::status_t &status, bool vouched)
{
    if (boot_ && *boot_ != status.boot && !restart_known_) {
        restarted();
    }
    boot_ = status.boot;
    restart_known_ = false;
    std::vector<std::string> warnings = commander_.warnings();
    if (witness_.is_alarmed(PoseWitness::Clock::now())) {
        warnings.push_back("Do not believe the position: " + std::to_string(witness_.forged()) +
                           " poses on the bus are not the robot's own.");
    }
    board_.pin(Topic::status, status_message(status, {vouched, std::move(warnings)}));
}

} // namespace console
