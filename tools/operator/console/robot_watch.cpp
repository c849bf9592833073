#include "operator/console/robot_watch.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/feed/checks.h"
#include "common/feed/core_types.h"
#include "operator/console/messages.h"

extern "C" {
#include "command/vouched.h"
}

namespace console
{

namespace
{

/* A pose that moves farther between two scans was relocated, not driven. */

/* A scan number this far back is a new start; one less far was overtaken on its way. */
constexpr int32_t overtaken_scans = 10;

/* Scan numbers run on over a gap of this size at most; beyond, somebody else is talking. */
constexpr int32_t largest_gap = 100000;

} // namespace

bool RobotWatch::hears()
{
    if (!commander_.believes()) {
        return speakers_.shows(sender(), SpeakerChoice::Clock::now());
    }
    return sender() == vouching_sender_ || !witness_.is_alarmed(PoseWitness::Clock::now());
}

uint64_t RobotWatch::sender() const
{
    return feed_ ? feed_->sender() : 0;
}

template <class Message>
void RobotWatch::follow(feed::LcmFeed &feed, const char *channel, void (RobotWatch::*take)(const Message &))
{
    feed.on<Message>(channel, [this, take](const Message &message) {
        if (hears()) {
            (this->*take)(message);
        }
    });
}

void RobotWatch::subscribe(feed::LcmFeed &feed)
{
    feed_ = &feed;
    feed.on_bytes("ALE_POSE", [this](const uint8_t *bytes, size_t count) {
        if (commander_.believes() || hears()) {
            pose_bytes(bytes, count);
        }
    });
    feed.on_bytes("ALE_VOUCHED", [this](const uint8_t *bytes, size_t count) { vouched_bytes(bytes, count); });
    follow(feed, "ALE_TRACKING", &RobotWatch::tracking);
    follow(feed, "ALE_PLAN", &RobotWatch::plan);
    follow(feed, "ALE_GRAPH", &RobotWatch::graph);
    follow(feed, "ALE_FEATURES", &RobotWatch::features);
    follow(feed, "ALE_SCAN", &RobotWatch::scan);
    follow(feed, "ALE_MAP", &RobotWatch::map);
    follow(feed, "ALE_MAP_PIECES", &RobotWatch::map_pieces);
    /* It comes from whoever counts the wheels, and not from the robot's own socket. */
    feed.on<ale::odometry_t>("ALE_ODOMETRY", [this](const ale::odometry_t &sample) { odometry(sample); });
    feed.on<ale::status_t>("ALE_STATUS", [this](const ale::status_t &message) { status(message); });
    feed.on<ale::speaker_t>("ALE_SPEAKER", [this](const ale::speaker_t &message) { speaker(message); });
}

void RobotWatch::speaker(const ale::speaker_t &speaker)
{
    speakers_.heard(speaker, SpeakerChoice::Clock::now());
}

void RobotWatch::restarted()
{
    board_.clear();
    map_parts_ = feed::MapParts();
    map_pieces_ = feed::MapPieces();
    window_ = WindowWatch();
    wheels_ = WheelWatch();
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
    if (!witness_.is_beyond(message.scan, now) && hears()) {
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
    board_.note_pose(Board::Clock::now(), static_cast<uint64_t>(gap), pose.state);
    board_.pin(Topic::pose, pose_message(pose));
    board_.see(pose);
    wheels_.pose(pose);
    show_wheels();
    last_pose_ = pose;
}

void RobotWatch::extend_trail(const ale::pose_t &pose)
{
    const bool jumped = last_pose_ && std::hypot(pose.map_x - last_pose_->map_x,
                                                 pose.map_y - last_pose_->map_y) > trail_jump_m;
    board_.extend_trail({pose.map_x, pose.map_y, jumped || !last_pose_});
}

void RobotWatch::tracking(const ale::tracking_t &tracking)
{
    feed::check(tracking);
    board_.pin(Topic::tracking, tracking_message(tracking));
    board_.see(tracking);
}

void RobotWatch::plan(const ale::plan_t &plan)
{
    feed::check(plan);
    board_.pin(Topic::plan, plan_message(plan));
}

void RobotWatch::graph(const ale::graph_t &graph)
{
    feed::check(graph);
    board_.pin(Topic::graph, graph_message(graph));
    board_.see(graph);
}

void RobotWatch::odometry(const ale::odometry_t &sample)
{
    feed::check(sample);
    wheels_.odometry(sample);
    show_wheels();
}

void RobotWatch::show_wheels()
{
    while (const auto way = wheels_.next()) {
        board_.pin(Topic::odometry, odometry_message(*way));
    }
}

void RobotWatch::features(const ale::features_t &features)
{
    feed::check(features);
    board_.pin(Topic::features, features_message(features), features_brief(features));
}

void RobotWatch::scan(const ale::scan_t &scan)
{
    feed::check(scan);
    if (last_pose_) {
        window_.scan(scan, static_cast<double>(last_pose_->theta));
    }
    board_.pin(Topic::scan, scan_message(scan, window_.stain()), scan_brief(scan));
    board_.see(scan);
}

void RobotWatch::map(const ale::map_t &part)
{
    feed::check(part);
    if (map_parts_.add(part)) {
        show_map();
    }
}

void RobotWatch::show_map()
{
    board_.keep_map(feed::core_map(map_parts_.whole(), map_pieces_));
    board_.pin(Topic::map, map_message(map_parts_.whole(), map_pieces_));
}

/* They come before the map that they are of; where they were overtaken, or come again because a part was
 * lost, the map that is shown already is told anew. */
void RobotWatch::map_pieces(const ale::map_pieces_t &part)
{
    feed::check(part);
    if (map_pieces_.add(part) && part.version == map_parts_.whole().version) {
        show_map();
    }
}

void RobotWatch::status(const ale::status_t &status)
{
    const bool taken = commander_.saw(status);
    if (taken && commander_.wants(status.robot) && sender() != 0 &&
        speakers_.choose(sender(), SpeakerChoice::Clock::now())) {
        restarted();
    }
    /* While two of one name speak, which one commands are for is open; which one is shown is not. */
    const bool goes_on = sender() != 0 && !commander_.believes() && status.robot == robot_;
    if ((taken || goes_on) && hears()) {
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
    vouching_sender_ = sender();
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
    robot_ = status.robot;
    restart_known_ = false;
    std::vector<std::string> warnings = commander_.warnings();
    if (const auto other = speakers_.warning(boot_, SpeakerChoice::Clock::now())) {
        warnings.push_back(*other);
    }
    if (witness_.is_alarmed(PoseWitness::Clock::now())) {
        warnings.push_back("Do not believe the position: " + std::to_string(witness_.forged()) +
                           " poses on the bus are not the robot's own.");
    }
    board_.pin(Topic::status, status_message(status, {vouched, std::move(warnings)}));
}

} // namespace console
