/* A scanner on a robot that drives through a world. Each beam is cast from where the sensor is at that
 * beam's own time, so the scans are bent by the motion as real ones are. */
#ifndef ALE_LAB_SIM_WORLD_SOURCE_H
#define ALE_LAB_SIM_WORLD_SOURCE_H

#include <algorithm>

#include "lab/sim/source.h"
#include "lab/sim/world/journey.h"
#include "lab/sim/world/sensor_noise.h"

namespace sim
{

class WorldSource : public Source
{
  public:
    struct Options {
        Journey::Options journey;
        std::string noise = "real";
        Scanner scanner;
        std::optional<Rotary> rotary; /* goes before scanner */
        int64_t rest_us = 0;          /* the robot stands so long before it begins its way */
        bool once = false;            /* ends a second after the way is over */
        int64_t odometry_lag_us = 0;  /* odometry tells where the wheels will be so much later */
    };

    WorldSource(const World &world, const Options &options);
    WorldSource(World world, const Options &options, Pilot pilot);
    WorldSource(const WorldSource &) = delete;
    WorldSource &operator=(const WorldSource &) = delete;

    const Scanner &scanner() const override
    {
        return scanner_;
    }
    std::optional<int64_t> due_us() override;
    Event next() override;
    std::optional<Pose> truth(int64_t play_us) override
    {
        return journey_.truth(way_us(play_us));
    }

    /* What the odometry stamped so says: where the wheels are a lag later. */
    Pose odometry(int64_t stamp_us)
    {
        return journey_.wheels(way_us(stamp_us + options_.odometry_lag_us));
    }
    const World &world() const
    {
        return world_;
    }
    uint32_t collisions() const
    {
        return journey_.collisions();
    }

  private:
    bool over(int64_t start_us) const;
    int64_t way_us(int64_t play_us) const
    {
        return options_.rest_us > 0 ? std::max<int64_t>(0, play_us - options_.rest_us) : play_us;
    }
    Turn measure(uint32_t number);
    Sweep measure_sweep(uint32_t number);
    double turned(double play_us) const;
    double sweep_start_us(uint32_t number) const;
    Hit before_walkers(Hit hit, const Pose &beam, int64_t play_us) const;
    int64_t turn_due_us() const;

    World world_;
    Options options_;
    Scanner scanner_;
    Journey journey_;
    SensorNoise noise_;
    uint32_t next_turn_ = 0; /* or sweep */
    int64_t next_odometry_us_ = 0;
};

} // namespace sim

#endif
