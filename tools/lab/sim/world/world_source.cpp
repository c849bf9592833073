#include "lab/sim/world/world_source.h"

#include <utility>

namespace sim
{

namespace
{

constexpr int64_t odometry_period_us = 50000;
constexpr int64_t rest_us = 1000000; /* the robot stands so long before it is all over */

} // namespace

WorldSource::WorldSource(const World &world, const Options &options)
    : WorldSource(world, options, route_pilot(world, options.journey.limits))
{
}

WorldSource::WorldSource(World world, const Options &options, Pilot pilot)
    : world_(std::move(world)), options_(options), journey_(world_, options.journey, std::move(pilot)),
      noise_(noise_model(options.noise), options.journey.seed, world_.walls.size() + world_.walkers.size())
{
}

int64_t WorldSource::turn_due_us() const
{
    return (static_cast<int64_t>(next_turn_) + 1) * scanner_.period_us() + reply_delay_us;
}

std::optional<int64_t> WorldSource::due_us()
{
    const int64_t turn_start_us = next_turn_ * scanner_.period_us();
    if (options_.once && journey_.end_us() && turn_start_us > *journey_.end_us() + rest_us) {
        return std::nullopt;
    }
    return std::min(turn_due_us(), next_odometry_us_);
}

Event WorldSource::next()
{
    if (next_odometry_us_ <= turn_due_us()) {
        const int64_t stamp_us = next_odometry_us_;
        next_odometry_us_ += odometry_period_us;
        return OdometryReport{stamp_us, odometry(stamp_us)};
    }
    return measure(next_turn_++);
}

/* What is hit when somebody stands in the beam's way. */
Hit WorldSource::before_walkers(Hit hit, const Pose &beam, int64_t play_us) const
{
    for (size_t k = 0; k < world_.walkers.size(); k++) {
        for (const Circle &leg : legs_of(world_.walkers[k], static_cast<double>(play_us) * 1e-6)) {
            hit = nearer(hit, beam, leg, static_cast<int>(world_.walls.size() + k));
        }
    }
    return hit;
}

Turn WorldSource::measure(uint32_t number)
{
    Turn turn;
    turn.number = number;
    turn.start_us = number * scanner_.period_us();
    const int32_t first = scanner_.first_step;
    const size_t beams = static_cast<size_t>(scanner_.last_step - first) + 1;
    const std::vector<double> errors = noise_.bearing_errors(number, beams);
    const Pose centre = compose(journey_.truth(turn.start_us), world_.sensor);
    const Surroundings near(world_.walls, {centre.x, centre.y}, scanner_.max_mm / 1000.0);
    std::vector<Hit> hits;
    for (size_t k = 0; k < beams; k++) {
        const int32_t step = first + static_cast<int32_t>(k);
        const int64_t beam_us = turn.start_us + scanner_.step_time_us(step);
        Pose beam = compose(journey_.truth(beam_us), world_.sensor);
        beam.theta += scanner_.bearing(step) + errors[k];
        hits.push_back(before_walkers(near.cast(beam), beam, beam_us));
    }
    const std::vector<int32_t> values = noise_.measure(number, hits);
    turn.value_mm.assign(static_cast<size_t>(scanner_.end_step) + 1, not_a_step);
    std::copy(values.begin(), values.end(), turn.value_mm.begin() + first);
    return turn;
}

} // namespace sim
