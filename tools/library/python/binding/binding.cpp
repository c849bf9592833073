#include "binding.h"

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/export/trajectory.h"
#include "common/offline/offline_slam.h"
#include "convert.h"
#include "settings.h"
#include "units.h"

extern "C" {
#include "store/map_file.h"
}

namespace
{

thread_local std::string last_error;

/* 0, or -1 with the reason kept: no exception leaves this library. */
int guarded(const std::function<void()> &work)
{
    try {
        work();
        return 0;
    } catch (const std::bad_alloc &) {
        last_error = "out of memory";
    } catch (const std::exception &error) {
        last_error = error.what();
    }
    return -1;
}

template <class T> T *made(const std::function<std::unique_ptr<T>()> &make)
{
    std::unique_ptr<T> object;
    return guarded([&] { object = make(); }) < 0 ? nullptr : object.release();
}

void check(int status, const char *error)
{
    if (status < 0) {
        throw std::runtime_error(error);
    }
}

} // namespace

struct ale_binding_extractor {
    explicit ale_binding_extractor(const ale_extract_config_t &config)
        : core(ale::core_object<ale_extractor_t>(ale_extractor_size()))
    {
        check(ale_extractor_init(core.get(), &config), "the extractor refuses a setting");
    }
    ale::CoreObject<ale_extractor_t> core;
    ale_pipeline_config_t config{};
    ale_scan_t scan{};
    ale_features_t features{};
};

struct ale_binding_tracker {
    ale_binding_tracker(const ale_pipeline_config_t &config, ale::OfflineSlam::Options options)
        : slam(config, options)
    {
    }
    ale::OfflineSlam slam;
    ale_scan_t scan{};
};

const char *ale_binding_error(void)
{
    return last_error.c_str();
}

ale_binding_extractor_t *ale_binding_extractor_new(const ale_binding_config_t *config)
{
    return made<ale_binding_extractor>([config] {
        const ale_pipeline_config_t all = ale::binding::config_of(*config);
        auto extractor = std::make_unique<ale_binding_extractor>(all.extract);
        extractor->config = all;
        return extractor;
    });
}

void ale_binding_extractor_free(ale_binding_extractor_t *extractor)
{
    delete extractor;
}

int ale_binding_extract(ale_binding_extractor_t *extractor, const ale_binding_scan_t *scan,
                        const ale_binding_features_t *out)
{
    return guarded([=] {
        ale::binding::fill_scan(extractor->scan, *scan);
        ale_scan_mask(&extractor->scan, extractor->config.blind, extractor->config.blind_count);
        ale_extract_scan(extractor->core.get(), &extractor->scan, nullptr, &extractor->features);
        ale::binding::put_features(*out, extractor->features);
    });
}

ale_binding_tracker_t *ale_binding_tracker_new(const ale_binding_config_t *config)
{
    return made<ale_binding_tracker>([config] {
        return std::make_unique<ale_binding_tracker>(
            ale::binding::config_of(*config),
            ale::OfflineSlam::Options{config->close_loops != 0, config->rebuilds_map != 0});
    });
}

void ale_binding_tracker_free(ale_binding_tracker_t *tracker)
{
    delete tracker;
}

int ale_binding_odometry(ale_binding_tracker_t *tracker, double stamp_s, const double pose[3])
{
    return guarded([=] {
        tracker->slam.odometry(
            {ale::binding::us_of(stamp_s),
             {ale::binding::um_of(pose[0]), ale::binding::um_of(pose[1]), ale::binding::bam_of(pose[2])}});
    });
}

int ale_binding_scan(ale_binding_tracker_t *tracker, const ale_binding_scan_t *scan,
                     ale_estimate_record_t *out)
{
    return guarded([=] {
        ale::binding::fill_scan(tracker->scan, *scan);
        *out = ale::binding::record_of(tracker->slam.scan(tracker->scan));
        out->cpu_s = static_cast<double>(tracker->slam.clock().total_ns()) / ale::binding::nano;
    });
}

int ale_binding_dropped(ale_binding_tracker_t *tracker, double stamp_s, ale_estimate_record_t *out)
{
    return guarded(
        [=] { *out = ale::binding::record_of(tracker->slam.dropped(ale::binding::us_of(stamp_s))); });
}

void ale_binding_features(const ale_binding_tracker_t *tracker, const ale_binding_features_t *out)
{
    ale::binding::put_features(*out, tracker->slam.features());
}

int ale_binding_finish(ale_binding_tracker_t *tracker)
{
    return guarded([=] { tracker->slam.finish(); });
}

uint32_t ale_binding_trajectory(const ale_binding_tracker_t *tracker, ale_pose_record_t *out)
{
    const auto &trajectory = tracker->slam.trajectory();
    if (out) {
        for (const ale::ScanPose &pose : trajectory) {
            *out++ = {ale::binding::seconds(pose.stamp_us), ale::binding::metres(pose.robot.x_um),
                      ale::binding::metres(pose.robot.y_um), ale::binding::radians(pose.robot.theta_bam),
                      pose.measured};
        }
    }
    return static_cast<uint32_t>(trajectory.size());
}

int ale_binding_save_trajectory(const ale_binding_tracker_t *tracker, const char *path)
{
    return guarded([=] {
        ale::TextFile file(path);
        for (const ale::ScanPose &pose : tracker->slam.trajectory()) {
            ale::put_tum_line(file, {pose.stamp_us, pose.robot});
        }
        file.close();
    });
}

int ale_binding_map(const ale_binding_tracker_t *tracker, ale_wall_record_t *walls,
                    ale_map_corner_record_t *corners, uint32_t counts[3])
{
    return guarded([=] {
        const auto map = std::make_unique<ale_map_t>();
        tracker->slam.copy_map(map.get());
        for (int i = 0; i < map->line_count; i++) {
            walls[i] = ale::binding::record_of(map->line[i]);
        }
        for (int i = 0; i < map->corner_count; i++) {
            corners[i] = ale::binding::record_of(map->corner[i]);
        }
        counts[0] = map->line_count;
        counts[1] = map->corner_count;
        counts[2] = map->refused;
    });
}

int ale_binding_save_map(const ale_binding_tracker_t *tracker, const char *path)
{
    return guarded([=] {
        const auto map = std::make_unique<ale_map_t>();
        char error[ALE_MAP_FILE_ERROR];
        tracker->slam.copy_map(map.get());
        check(ale_map_file_save(path, map.get(), error), error);
    });
}

int ale_binding_load_map(ale_binding_tracker_t *tracker, const char *path)
{
    return guarded([=] {
        const auto map = std::make_unique<ale_map_t>();
        char error[ALE_MAP_FILE_ERROR];
        check(ale_map_file_load(path, map.get(), error), error);
        tracker->slam.load_map(*map);
    });
}
