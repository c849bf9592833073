#include "common/log/log_noise.h"

extern "C" {
#include "config/presets.h"
}

namespace ale
{

ale_noise_t noise_of_log(const ale_log_info_t &info)
{
    char name[ALE_PRESET_NAME];
    ale_noise_t noise = ale_noise_default();
    if (ale_preset_identify(info.scanner, name)) {
        ale_preset_noise(name, &noise);
    } else if (!info.urg_noise) {
        ale_preset_noise("lms-200", &noise);
    }
    return noise;
}

} // namespace ale
