// Recordings simulated with a known noise model: the fit must find it again.
#include <gtest/gtest.h>

#include <fstream>

#include "files.hpp"
#include "robot/calibrate/configuration.h"
#include "robot/calibrate/noise_plot.h"
#include "tools/robot/calibrate/simulated_recording.hpp"

extern "C" {
#include "config/config.h"
}

namespace
{

using namespace simulated;

void write_log(const Simulation &s, int scans, double speed, const std::string &path)
{
    std::ofstream log(path);
    bench::Random random(5);
    for (int k = 0; k < scans; k++) {
        log << "ROBOTLASER1 2 -2.086213872 4.178563666 0.006135923 4.094 0.010 0 682";
        for (const double range : s.scan(random, {speed * k, 0, 0})) {
            log << " " << range;
        }
        log << " 0 0 0 0 0 0 0 0 0 0 0 0 " << k * 0.1 << " test " << k * 0.1 << "\n";
    }
}

void expect_within(double got, double truth, double share, const char *what)
{
    EXPECT_NEAR(got, truth, share * truth) << what;
}

class RecoveredParameters : public testing::TestWithParam<Truth>
{
};

TEST_P(RecoveredParameters, are_within_ten_per_cent)
{
    const Truth truth = GetParam();
    const calibrate::Calibration c = calibrate::calibrate(recording_of(simulation(truth), 1200));
    expect_within(c.noise.own_um, truth.noise.own_um, 0.1, "own_um");
    expect_within(c.noise.own_ppm, truth.noise.own_ppm, 0.1, "own_ppm");
    if (truth.noise.shared_um == 0) {
        EXPECT_LT(c.noise.shared_um, truth.noise.own_um / 10);
        EXPECT_LT(c.noise.shared_ppm, truth.noise.own_ppm / 10);
    } else {
        expect_within(c.noise.shared_um, truth.noise.shared_um, 0.1, "shared_um");
        expect_within(c.noise.shared_ppm, truth.noise.shared_ppm, 0.1, "shared_ppm");
        expect_within(c.noise.shared_beams, truth.noise.shared_beams, 0.1, "shared_beams");
    }
    expect_within(c.noise.bearing_nrad, truth.noise.bearing_nrad, 0.1, "bearing_nrad");
    EXPECT_NEAR(c.mixed.share, truth.mixed, 0.1 * truth.mixed + 0.01);
}

INSTANTIATE_TEST_SUITE_P(Noise, RecoveredParameters,
                         testing::Values(Truth{{1500, 800, 2000, 2000, 12, 6000, 872665}, 0.3},
                                         Truth{{3000, 2500, 3000, 3000, 8, 9000, 1500000}, 0.15},
                                         Truth{{4000, 5000, 0, 0, 12, 5000, 2000000}, 0.05}));

std::string message_of(const std::string &path)
{
    try {
        calibrate::calibrate(calibrate::read_recording(path));
    } catch (const std::runtime_error &e) {
        return e.what();
    }
    return "";
}

// A bias is told from distance by how it bends a wall. Three of them are known to a few millimetres only.
TEST(Calibration, the_bias_of_surfaces_is_found_where_walls_are_seen_under_wide_angles)
{
    const Truth truth{{1500, 800, 1000, 500, 12, 12000, 872665}, 0};
    const calibrate::Calibration c = calibrate::calibrate(recording_of(simulation(truth, triangle()), 1000));
    EXPECT_TRUE(c.surface_known);
    expect_within(c.noise.surface_um, truth.noise.surface_um, 0.25, "surface_um");
}

TEST(Calibration, a_log_file_gives_what_the_table_gave)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "rest.log";
    write_log(simulation(usual), 60, 0, path);
    const calibrate::Recording recording = calibrate::read_recording(path);
    EXPECT_EQ(recording.scans(), 60);
    EXPECT_EQ(recording.beams(), bench::urg_beams);
    EXPECT_NEAR(recording.step, bench::urg_step, 1e-8);
    const calibrate::Recording same = recording_of(simulation(usual), 60);
    EXPECT_NEAR(recording.range(59, 300), same.range(59, 300), 1e-9);
    EXPECT_NEAR(recording.bearing(681), same.bearing(681), 1e-6);
}

TEST(Calibration, the_fragment_is_a_configuration_that_the_firmware_reads)
{
    const calibrate::Calibration c = calibrate::calibrate(recording_of(simulation(usual), 60));
    ale_config_t config = ale_config_default();
    ale_config_error_t error;
    ASSERT_EQ(ale_config_parse(calibrate::configuration(c, "rest.log").c_str(), "fragment", &config, &error),
              0)
        << error.message;
    const ale_noise_t &read = config.pipeline.extract.noise;
    EXPECT_EQ(read.own_um, c.noise.own_um);
    EXPECT_EQ(read.shared_ppm, c.noise.shared_ppm);
    EXPECT_EQ(read.bearing_nrad, c.noise.bearing_nrad);
}

TEST(Calibration, the_plot_is_a_picture_with_three_panels)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "fit.svg";
    calibrate::plot(calibrate::calibrate(recording_of(simulation(usual), 60)), "rest.log", path);
    const std::string text = files::content(path);
    for (const char *title : {"range, m", "beams apart", "slope |dr/dphi|, m/rad", "that last", "</svg>"}) {
        EXPECT_NE(text.find(title), std::string::npos) << title;
    }
}

TEST(Calibration, a_moving_scanner_is_refused)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "moving.log";
    write_log(simulation(usual), 60, 0.01, path);
    EXPECT_NE(message_of(path).find("the scanner moves"), std::string::npos);
}

TEST(Calibration, too_few_scans_are_refused_with_their_number)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "short.log";
    write_log(simulation(usual), 7, 0, path);
    EXPECT_NE(message_of(path).find("7 scans, at least 20"), std::string::npos);
}

TEST(Calibration, a_recording_without_any_surface_is_refused)
{
    calibrate::Recording nothing = recording_of(simulation(usual), 30);
    nothing.range.setConstant(not_a_value);
    EXPECT_THROW(calibrate::calibrate(nothing), std::runtime_error);
}

} // namespace
