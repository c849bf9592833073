#include "lab/sim/world/world_source.h"

#include <cmath>
#include <utility>

namespace sim
{

namespace
{

constexpr int64_t odometry_period_us = 50000;
constexpr int64_t rest_us = 1000000; /* the robot stands so long before it is all over */
constexpr double wander_us = 7e6;    /* period in which a motor's speed wanders */

} // namespace

WorldSource::WorldSource(const World &world, const Options &options)
    : WorldSource(world, options, route_pilot(world, options.journey.limits))
{
}

WorldSource::WorldSource(World world, const Options &options, Pilot pilot)
    : world_(std::move(world)), options_(options), scanner_(options.scanner),
      journey_(world_, options.journey, std::move(pilot)),
      noise_(noise_model(options.noise), options.journey.seed, world_.walls.size() + world_.walkers.size())
{
}

/* Turns of a rotary scanner's head since the play began. */
double WorldSource::turned(double play_us) const
{
    const double slow = 2 * pi / wander_us;
    return options_.rotary->turns_a_second * 1e-6 *
           (play_us + options_.rotary->wander / slow * std::sin(slow * play_us));
}

double WorldSource::sweep_start_us(uint32_t number) const
{
    return number * (options_.rotary->packet_points * options_.rotary->point_us());
}

int64_t WorldSource::turn_due_us() const
{
    if (options_.rotary) {
        const double last_us = sweep_start_us(next_turn_ + 1) - options_.rotary->point_us();
        return static_cast<int64_t>(last_us) + options_.rotary->line_us;
    }
    return (static_cast<int64_t>(next_turn_) + 1) * scanner_.period_us() + reply_delay_us;
}

bool WorldSource::over(int64_t start_us) const
{
    return options_.once && journey_.end_us() && start_us > options_.rest_us + *journey_.end_us() + rest_us;
}

std::optional<int64_t> WorldSource::due_us()
{
    if (over(options_.rotary ? static_cast<int64_t>(sweep_start_us(next_turn_))
                             : next_turn_ * scanner_.period_us())) {
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
    if (options_.rotary) {
        return measure_sweep(next_turn_++);
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
    const Pose centre = compose(journey_.truth(way_us(turn.start_us)), world_.sensor);
    const Surroundings near(world_.walls, {centre.x, centre.y}, scanner_.max_mm / 1000.0);
    std::vector<Hit> hits;
    for (size_t k = 0; k < beams; k++) {
        const int32_t step = first + static_cast<int32_t>(k);
        const int64_t beam_us = turn.start_us + scanner_.step_time_us(step);
        Pose beam = compose(journey_.truth(way_us(beam_us)), world_.sensor);
        beam.theta += scanner_.bearing(step) + errors[k];
        hits.push_back(before_walkers(near.cast(beam), beam, beam_us));
    }
    const std::vector<int32_t> values = noise_.measure(number, hits);
    turn.value_mm.assign(static_cast<size_t>(scanner_.end_step) + 1, not_a_step);
    std::copy(values.begin(), values.end(), turn.value_mm.begin() + first);
    return turn;
}

/* The points of one packet; what the scanner would have as an error of a URG is nothing to it. */
Sweep WorldSource::measure_sweep(uint32_t number)
{
    const Rotary &rotary = *options_.rotary;
    Sweep sweep;
    sweep.number = number;
    sweep.start_us = sweep_start_us(number);
    sweep.end_us = sweep_start_us(number + 1) - rotary.point_us();
    sweep.degrees_a_second =
        360e6 * (turned(sweep.end_us) - turned(sweep.start_us)) / (sweep.end_us - sweep.start_us);
    sweep.turn = static_cast<uint32_t>(turned(sweep.end_us));
    sweep.begins_turn =
        number == 0 || sweep.turn > static_cast<uint32_t>(turned(sweep.start_us - rotary.point_us()));
    const std::vector<double> errors = noise_.bearing_errors(number, rotary.packet_points);
    const Pose centre = compose(journey_.truth(way_us(static_cast<int64_t>(sweep.start_us))), world_.sensor);
    const Surroundings near(world_.walls, {centre.x, centre.y}, rotary.max_mm / 1000.0);
    std::vector<Hit> hits;
    for (uint32_t k = 0; k < rotary.packet_points; k++) {
        const double beam_us = sweep.start_us + k * rotary.point_us();
        const double clockwise = turned(beam_us) - std::floor(turned(beam_us));
        Pose beam = compose(journey_.truth(way_us(std::llround(beam_us))), world_.sensor);
        beam.theta += -2 * pi * clockwise + errors[k];
        hits.push_back(before_walkers(near.cast(beam), beam, std::llround(beam_us)));
        sweep.echoes.push_back({360 * clockwise, 0});
    }
    const std::vector<int32_t> values = noise_.measure(number, hits);
    for (uint32_t k = 0; k < rotary.packet_points; k++) {
        const bool measurable = values[k] >= rotary.min_mm && values[k] <= rotary.max_mm;
        sweep.echoes[k].mm = measurable ? values[k] : 0;
    }
    return sweep;
}

} // namespace sim
