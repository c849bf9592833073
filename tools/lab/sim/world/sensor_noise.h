/* How a URG-04LX errs, and what it answers where it sees nothing.
 *
 * Default `real`, after recordings of the sensor: each beam errs by itself (1.5 mm + 0.08 % of the range),
 * neighbours share an error (2 mm + 0.2 %) that wanders over about 12 beams, every wall has a bias of its own
 * (6 mm: colour, gloss), 30 % of the depth edges show a mixed pixel, 1 % of the beams fail, more at grazing
 * incidence. `white`: max(3 mm, 0.7 %) of each beam alone and 2 % failures. `none`: the exact distance. Other
 * scanners err by models of their own, after their data sheets. */
#ifndef ALE_LAB_SIM_SENSOR_NOISE_H
#define ALE_LAB_SIM_SENSOR_NOISE_H

#include <cstdint>
#include <string>
#include <vector>

#include "lab/sim/world/ray_cast.h"

namespace sim
{

/* Standard deviations in metres, radians and parts of the range; chances 0..1. */
struct NoiseModel {
    const char *name;
    double own_floor;
    double own_constant;
    double own_proportional;
    double own_quadratic; /* of a triangulating scanner: metres at a range of one metre, growing with its
                             square */
    double shared_constant;
    double shared_proportional;
    double surface;
    double bearing;
    double mixed_pixel;
    double dropout;
    double grazing_dropout; /* chance of failure of a beam that runs along its wall */
};

/* Throws cli::WrongUse that lists the names there are. */
const NoiseModel &noise_model(const std::string &name);

/* Errors of one run: everything follows from the seed and the number of the scan. */
class SensorNoise
{
  public:
    SensorNoise(const NoiseModel &model, uint64_t seed, size_t surfaces);

    /* Errors of the bearings of a scan's beams, radians. */
    std::vector<double> bearing_errors(uint32_t scan, size_t beams) const;

    /* Values in mm, error codes included, of the beams of a scan. */
    std::vector<int32_t> measure(uint32_t scan, const std::vector<Hit> &hits) const;

  private:
    const NoiseModel &model_;
    uint64_t seed_;
    std::vector<double> surface_bias_;
};

} // namespace sim

#endif
