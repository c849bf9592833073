/* What comes from the robot, checked, and pinned to the board. LCM thread only. */
#ifndef CONSOLE_ROBOT_WATCH_H
#define CONSOLE_ROBOT_WATCH_H

#include <cstdint>
#include <optional>
#include <string>

#include "ale/features_t.hpp"
#include "ale/graph_t.hpp"
#include "ale/map_t.hpp"
#include "ale/odometry_t.hpp"
#include "ale/plan_t.hpp"
#include "ale/pose_t.hpp"
#include "ale/scan_t.hpp"
#include "ale/status_t.hpp"
#include "ale/tracking_t.hpp"
#include "common/feed/lcm_feed.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "operator/console/board.h"
#include "operator/console/commander.h"
#include "operator/console/pose_witness.h"
#include "operator/console/speaker_choice.h"
#include "operator/console/wheel_watch.h"
#include "operator/console/window_watch.h"

namespace console
{

class RobotWatch
{
  public:
    RobotWatch(Board &board, Commander &commander) : board_(board), commander_(commander)
    {
    }

    /* From then on what comes from a robot that is not the one shown is left out. The feed must outlive the
     * watch's last message. */
    void subscribe(feed::LcmFeed &feed);

    /* Whether what is just handled is of the robot that is shown. Where a robot vouches for what it says,
     * others are told by that; while some are found to speak in its name, only the socket is heard that its
     * word came from. */
    bool hears();

    /* Each throws std::runtime_error for a message that makes no sense; it is counted as malformed. */
    void pose(const ale::pose_t &pose);
    void tracking(const ale::tracking_t &tracking);
    void plan(const ale::plan_t &plan);
    void graph(const ale::graph_t &graph);
    void odometry(const ale::odometry_t &sample);
    void features(const ale::features_t &features);
    void scan(const ale::scan_t &scan);
    void map(const ale::map_t &part);
    void map_pieces(const ale::map_pieces_t &part);
    void status(const ale::status_t &status);
    void speaker(const ale::speaker_t &speaker);

    /* The bytes of an ALE_POSE and an ALE_VOUCHED, as they came. */
    void pose_bytes(const uint8_t *bytes, size_t count);
    void vouched_bytes(const uint8_t *bytes, size_t count);

  private:
    template <class Message>
    void follow(feed::LcmFeed &feed, const char *channel, void (RobotWatch::*take)(const Message &));
    uint64_t sender() const;
    void show_map();
    void show(const ale::status_t &status, bool vouched);
    void restarted();
    void extend_trail(const ale::pose_t &pose);
    void show_wheels();

    Board &board_;
    Commander &commander_;
    feed::MapParts map_parts_;
    feed::MapPieces map_pieces_;
    WindowWatch window_;
    WheelWatch wheels_;
    PoseWitness witness_;
    SpeakerChoice speakers_;
    const feed::LcmFeed *feed_ = nullptr;
    uint64_t vouching_sender_ = 0; /* of the newest word of the robot that is believed */
    std::optional<ale::pose_t> last_pose_;
    std::optional<int64_t> boot_; /* of the start that is shown, */
    std::string robot_;           /* and its robot */
    bool restart_known_ = false;  /* the scan numbers told before the next status does */
};

} // namespace console

#endif
