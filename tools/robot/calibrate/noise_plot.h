/* The fit of the noise model as a picture. */
#ifndef ALE_ROBOT_CALIBRATE_NOISE_PLOT_H
#define ALE_ROBOT_CALIBRATE_NOISE_PLOT_H

#include "robot/calibrate/noise_fit.h"

namespace calibrate
{

/* Noise over range, correlation over beams, noise over slope. Throws as SvgDrawing::save. */
void plot(const Calibration &calibration, const std::string &source, const std::string &path);

} // namespace calibrate

#endif
