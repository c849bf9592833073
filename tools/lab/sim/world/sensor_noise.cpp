#include "lab/sim/world/sensor_noise.h"

#include <algorithm>
#include <iterator>

#include "common/command_line/wrong_use.h"
#include "lab/bench/random.hpp"

namespace sim
{

namespace
{

using bench::Random;

constexpr NoiseModel models[] = {
    {"real", 0, 0.0015, 0.0008, 0, 0.002, 0.002, 0.006, 0.00087, 0.3, 0.01, 0.5},
    {"white", 0.003, 0, 0.007, 0, 0, 0, 0, 0.00087, 0.3, 0.02, 0},
    {"none", 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    /* LDROBOT: standard deviation 10 mm on all of its range; nothing back of 2 % even of good walls. */
    {"ld06", 0, 0.010, 0, 0, 0, 0, 0.005, 0.0017, 0.3, 0.02, 0.5},
    /* SLAMTEC A1, A2: it triangulates, 1 % of the range at 3 m, growing with its square; dark walls give
       nothing. */
    {"rplidar-a1", 0, 0.002, 0.001, 0.0022, 0, 0, 0.005, 0.0026, 0.3, 0.03, 0.6},
    /* Hokuyo: repeatability below 10 mm to 10 m (UST), below 30 mm to 10 m (UTM: 10 mm). */
    {"ust-10lx", 0, 0.007, 0.0003, 0, 0.003, 0, 0.005, 0.00087, 0.3, 0.005, 0.5},
    {"utm-30lx", 0, 0.008, 0.0003, 0, 0.003, 0, 0.005, 0.00087, 0.3, 0.005, 0.5},
};

constexpr double shared_beams = 12;    /* over so many beams the shared error falls to 1/e */
constexpr double depth_edge = 0.05;    /* metres between neighbours that belong to two surfaces */
constexpr double grazing_cosine = 0.2; /* below it a beam begins to fail */
constexpr int32_t nearest_mm = 20;     /* values below are codes */

/* SCIP's codes of failed beams, as often as a recorded device gives them. */
constexpr int32_t nothing_seen = 0;
constexpr int32_t neighbours_failed = 7;
constexpr int32_t failures[] = {0, 0, 0, 0, 0, 0, 0, neighbours_failed, 1, 10};

/* Independent streams from one seed: a scan's errors do not depend on which scans were asked for. */
enum class Stream : uint64_t { surfaces = 1, bearings = 2, ranges = 3 };

Random stream(uint64_t seed, Stream kind, uint32_t scan)
{
    return Random(seed * 0x9e3779b97f4a7c15u ^ (static_cast<uint64_t>(kind) << 32) ^ scan);
}

/* A process of variance 1 that forgets over shared_beams. */
class Wandering
{
  public:
    explicit Wandering(Random &random) : now_(random.normal())
    {
    }
    double next(Random &random)
    {
        const double before = now_;
        now_ = keep_ * now_ + std::sqrt(1 - keep_ * keep_) * random.normal();
        return before;
    }

  private:
    double keep_ = std::exp(-1 / shared_beams);
    double now_;
};

bool at_edge(const Hit &a, const Hit &b)
{
    return a.surface >= 0 && b.surface >= 0 && a.surface != b.surface &&
           std::fabs(a.range - b.range) > depth_edge;
}

double chance_of_failure(const NoiseModel &model, const Hit &hit)
{
    const double grazing = std::max(0.0, 1 - hit.cos_incidence / grazing_cosine);
    return model.dropout + model.grazing_dropout * grazing;
}

int32_t in_millimetres(double metres)
{
    return std::max(nearest_mm, static_cast<int32_t>(std::lround(metres * 1000)));
}

} // namespace

const NoiseModel &noise_model(const std::string &name)
{
    const auto *found = std::find_if(std::begin(models), std::end(models),
                                     [&](const NoiseModel &m) { return name == m.name; });
    if (found == std::end(models)) {
        std::string names;
        for (const NoiseModel &model : models) {
            names += (names.empty() ? "" : ", ") + std::string(model.name);
        }
        throw cli::WrongUse("--noise " + name + ": there are " + names);
    }
    return *found;
}

SensorNoise::SensorNoise(const NoiseModel &model, uint64_t seed, size_t surfaces) : model_(model), seed_(seed)
{
    Random random = stream(seed, Stream::surfaces, 0);
    for (size_t k = 0; k < surfaces; k++) {
        surface_bias_.push_back(model.surface * random.normal());
    }
}

std::vector<double> SensorNoise::bearing_errors(uint32_t scan, size_t beams) const
{
    Random random = stream(seed_, Stream::bearings, scan);
    std::vector<double> errors(beams);
    for (double &error : errors) {
        error = model_.bearing * random.normal();
    }
    return errors;
}

std::vector<int32_t> SensorNoise::measure(uint32_t scan, const std::vector<Hit> &hits) const
{
    Random random = stream(seed_, Stream::ranges, scan);
    Wandering wandering(random);
    std::vector<int32_t> values(hits.size());
    for (size_t k = 0; k < hits.size(); k++) {
        const Hit &hit = hits[k];
        const double shared = wandering.next(random);
        const double own = random.normal();
        const bool mixed =
            k + 1 < hits.size() && at_edge(hit, hits[k + 1]) && random.chance(model_.mixed_pixel);
        const bool failed = random.chance(chance_of_failure(model_, hit));
        if (hit.surface < 0) {
            values[k] = nothing_seen;
        } else if (failed) {
            values[k] =
                failures[static_cast<size_t>(random.integer(0, static_cast<int>(std::size(failures)) - 1))];
        } else if (mixed) {
            values[k] = in_millimetres(random.uniform(hit.range, hits[k + 1].range));
        } else {
            const double own_sigma = std::max(
                model_.own_floor, std::hypot(model_.own_constant, model_.own_proportional * hit.range,
                                             model_.own_quadratic * hit.range * hit.range));
            const double shared_sigma =
                std::hypot(model_.shared_constant, model_.shared_proportional * hit.range);
            values[k] = in_millimetres(hit.range + own_sigma * own + shared_sigma * shared +
                                       surface_bias_[static_cast<size_t>(hit.surface)]);
        }
    }
    return values;
}

} // namespace sim
