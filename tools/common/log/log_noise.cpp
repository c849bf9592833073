#include "common/log/log_noise.h"

namespace ale
{

ale_noise_t noise_of_log(const ale_log_info_t &info)
{
    ale_noise_t noise = ale_noise_default();
    if (!info.urg_noise) {
        /* SICK LMS 2xx and the like, by their data sheet: 5 mm (one sigma) and steps of 10 mm of each beam's
         * own, up to 15 mm of systematic error. */
        noise.own_um = 6000;
        noise.own_ppm = 0;
        noise.shared_um = 5000;
        noise.shared_ppm = 0;
        noise.surface_um = 8000;
    }
    return noise;
}

} // namespace ale
