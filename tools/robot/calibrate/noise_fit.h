/* The noise model of lib/base/noise.h fitted to a recording of a scanner at rest. */
#ifndef ALE_ROBOT_CALIBRATE_NOISE_FIT_H
#define ALE_ROBOT_CALIBRATE_NOISE_FIT_H

#include <string>
#include <vector>

#include "robot/calibrate/lasting.h"
#include "robot/calibrate/mixed_pixels.h"
#include "robot/calibrate/temporal.h"

extern "C" {
#include "base/noise.h"
}

namespace calibrate
{

struct Calibration {
    int scans = 0;
    std::vector<Beam> beams;
    std::vector<Product> products;
    TemporalFit temporal;
    LastingFit lasting;
    MixedPixels mixed;
    ale_noise_t noise; /* changing and lasting errors together */
    bool surface_known = false;
};

/* Throws std::runtime_error where the scanner moves (rest.h) or the recording says too little. */
Calibration calibrate(const Recording &recording);

/* What neighbouring beams err alike, the part that changes from scan to scan apart from the one that lasts.
 */
std::string shared_in_words(const Calibration &calibration);

/* Section [noise] of the firmware's configuration, with what it rests on as comments. */
std::string configuration(const Calibration &calibration, const std::string &source);

} // namespace calibrate

#endif
