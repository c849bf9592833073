#include "config/config.h"

ale_config_t ale_config_default(void)
{
    const ale_explorer_config_t explorer = ale_explorer_default_config();
    ale_config_t config = {
        .pipeline = ale_pipeline_default_config(),
        .robot = explorer.follower.shape,
        .explore_speed_um_s = explorer.follower.speed_um_s,
        .explore_turn_urad_s = explorer.follower.turn_urad_s,
        .explore_clearance_um = explorer.clearance_um,
        .type = "urg",
        .port = "/dev/ttyACM0",
        .priority = 80,
        .cpu = -1,
        .lock_memory = true,
        .map_folder = "/var/lib/ale-slam",
        .name = "robot",
        .drive_baud = 115200,
        .drive_um_s = 500000,
        .drive_urad_s = 1000000,
        .keep_seconds = 10,
        .recorder_megabytes = 8,
    };
    return config;
}

ale_explorer_config_t ale_config_explorer(const ale_config_t *config)
{
    const ale_explorer_config_t explorer = {.follower = {.shape = config->robot,
                                                         .sensor = config->pipeline.sensor,
                                                         .speed_um_s = config->explore_speed_um_s,
                                                         .turn_urad_s = config->explore_turn_urad_s},
                                            .clearance_um = config->explore_clearance_um};
    return explorer;
}
