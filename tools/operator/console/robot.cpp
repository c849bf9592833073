#include "operator/console/robot.h"

namespace console
{

namespace
{

/* Of the robot that is shown. */
constexpr const char *own_channels[] = {"ALE_POSE",   "ALE_TRACKING",   "ALE_FEATURES", "ALE_SCAN",
                                        "ALE_MAP",    "ALE_MAP_PIECES", "ALE_GRAPH",    "ALE_PLAN",
                                        "ALE_STATUS", "ALE_VOUCHED"};
/* Of its wheels, and of whoever speaks. */
constexpr const char *common_channels[] = {"ALE_ODOMETRY", "ALE_ODOMETRY_EXACT", "ALE_SPEAKER"};

} // namespace

/* It is recorded as the bus has it, before it is looked at. Commands and set points are left out: who plays a
 * recording on a robot's bus must not move it. */
Robot::Robot(const RobotSettings &settings)
    : name_(settings.name), feed_(settings.credentials.lcm_url), commander_(settings.credentials),
      watch_(board_, commander_), shelves_{{settings.recordings, ".lcm"},
                                           {settings.recordings, ".scip"},
                                           {settings.flights, ".scip"},
                                           {settings.maps, ".map"}},
      recorder_(shelves_.recordings), archive_(board_, shelves_), desk_(archive_, recorder_)
{
    for (const char *channel : own_channels) {
        record(channel, false);
    }
    for (const char *channel : common_channels) {
        record(channel, true);
    }
    watch_.subscribe(feed_);
}

void Robot::record(const char *channel, bool whoever_speaks)
{
    feed_.on_bytes(channel, [this, channel, whoever_speaks](const uint8_t *bytes, size_t count) {
        if (whoever_speaks || watch_.hears()) {
            recorder_.take(channel, bytes, count);
        }
    });
}

void Robot::follow(const std::atomic<bool> &stopping)
{
    while (!stopping) {
        feed_.wait(100);
        commander_.keep_stopped();
        board_.note_malformed(feed_.refused());
    }
}

} // namespace console
