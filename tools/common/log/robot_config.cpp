#include "common/log/robot_config.h"

#include "common/command_line/robot_files.h"
#include "common/log/log_noise.h"

extern "C" {
#include "config/config_model.h"
}

namespace ale
{

namespace
{

void load(ale_config_t &config, const RobotOptions &options, const char *recorded)
{
    ale_config_error_t error;
    if (!options.config.empty()) {
        cli::load_config(options.config, config);
    } else if (recorded &&
               ale_config_parse(recorded, "configuration in the recording", &config, &error) < 0) {
        throw cli::WrongUse(error.message);
    }
}

} // namespace

ale_config_t robot_config(const RobotOptions &options, const ale_log_info_t &info, const char *recorded)
{
    ale_config_t config = ale_config_default();
    config.pipeline.extract.noise = noise_of_log(info);
    if (info.has_sensor) {
        config.pipeline.sensor = info.sensor;
    }
    if (info.lag_prior_us != 0) {
        config.pipeline.odometry_lag_us = info.lag_prior_us;
    }
    load(config, options, recorded);
    if (!options.model.empty()) {
        ale_config_use_preset(&config, options.model.c_str());
    }
    if (options.sensor) {
        config.pipeline.sensor = *options.sensor;
    }
    config.pipeline.use_odometry = config.pipeline.use_odometry && options.use_odometry && info.has_odometry;
    return config;
}

ale_scan_t mounted(const ale_scan_t &scan, bool upside_down)
{
    ale_scan_t turned = scan;
    if (upside_down) {
        turned.first_bearing_bam = 0U - scan.first_bearing_bam;
        turned.step_bam = -scan.step_bam;
        for (uint32_t &bearing_bam : turned.bearing_bam) {
            bearing_bam = 0U - bearing_bam;
        }
    }
    return turned;
}

} // namespace ale
