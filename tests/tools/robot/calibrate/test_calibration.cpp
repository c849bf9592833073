// Recordings simulated with a known noise model: the fit must find it again.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "files.hpp"
#include "lab/bench/simulate.hpp"
#include "robot/calibrate/calibration.h"

extern "C" {
#include "config/config.h"
}

namespace
{

constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();

struct Truth {
    ale_noise_t noise;
    double mixed;
};

// A room of many walls, near and far, seen flat and slanted, with a box in it for depth edges.
bench::World room_of_many_walls()
{
    bench::World world;
    const std::vector<bench::Point> corners{{-0.6, -0.5}, {0.3, -0.7}, {1.1, -0.8}, {2.2, -2.4},
                                            {3.6, -2.2},  {3.9, 0.2},  {3.0, 1.8},  {1.2, 1.6},
                                            {0.2, 3.4},   {-2.2, 2.6}, {-2.6, 0.3}};
    for (std::size_t k = 0; k < corners.size(); k++) {
        world.walls.push_back({corners[k], corners[(k + 1) % corners.size()]});
    }
    const std::vector<bench::Point> box{{1.3, -0.6}, {1.6, -0.5}, {1.5, -0.2}, {1.2, -0.3}};
    for (std::size_t k = 0; k < box.size(); k++) {
        world.walls.push_back({box[k], box[(k + 1) % box.size()]});
    }
    return world;
}

// Three walls seen under the widest angles that 240 degrees allow.
bench::World triangle()
{
    bench::World world;
    world.walls = {{{-1.2, -1}, {2.4, -0.9}}, {{2.4, -0.9}, {-0.4, 1.6}}, {{-0.4, 1.6}, {-1.2, -1}}};
    world.heading = 0.5;
    return world;
}

bool at_edge(const bench::Hit &a, const bench::Hit &b)
{
    return a.surface != b.surface && std::abs(a.range - b.range) > 0.2;
}

struct Simulation {
    bench::World world;
    Truth truth;
    std::vector<double> bias;

    double own_sigma(double d) const
    {
        return std::hypot(truth.noise.own_um * 1e-6, truth.noise.own_ppm * 1e-6 * d);
    }
    double shared_sigma(double d) const
    {
        return std::hypot(truth.noise.shared_um * 1e-6, truth.noise.shared_ppm * 1e-6 * d);
    }
    std::vector<double> scan(bench::Random &random, double moved) const
    {
        const double keep = std::exp(-1.0 / truth.noise.shared_beams);
        double shared = random.normal();
        std::vector<double> ranges(bench::urg_beams, not_a_value);
        std::vector<bench::Hit> exact;
        bench::World at = world;
        at.sensor.x() += moved;
        for (int k = 0; k < bench::urg_beams; k++) {
            exact.push_back(bench::cast(at, bench::urg_bearing(k)));
            const double jitter = truth.noise.bearing_nrad * 1e-9 * random.normal();
            const bench::Hit hit = bench::cast(at, bench::urg_bearing(k) + jitter);
            const double range = hit.range + bias[static_cast<std::size_t>(hit.surface)] +
                                 own_sigma(hit.range) * random.normal() + shared_sigma(hit.range) * shared;
            ranges[static_cast<std::size_t>(k)] = std::round(range * 1000) / 1000;
            shared = keep * shared + std::sqrt(1 - keep * keep) * random.normal();
        }
        for (std::size_t k = 0; k + 1 < exact.size(); k++) {
            if (at_edge(exact[k], exact[k + 1]) && random.chance(truth.mixed)) {
                ranges[k] = random.uniform(exact[k].range, exact[k + 1].range);
            }
        }
        return ranges;
    }
};

Simulation simulation(const Truth &truth, const bench::World &world = room_of_many_walls())
{
    Simulation s{world, truth, {}};
    bench::Random random(77);
    double square = 0;
    for (std::size_t k = 0; k < s.world.walls.size(); k++) {
        s.bias.push_back(random.normal());
        square += s.bias.back() * s.bias.back() / static_cast<double>(s.world.walls.size());
    }
    for (double &b : s.bias) {
        b *= truth.noise.surface_um * 1e-6 / std::sqrt(square);
    }
    return s;
}

calibrate::Recording recording_of(const Simulation &s, int scans)
{
    calibrate::Recording recording;
    bench::Random random(5);
    recording.range.resize(scans, bench::urg_beams);
    for (int k = 0; k < scans; k++) {
        std::vector<double> ranges = s.scan(random, 0);
        recording.range.row(k) = Eigen::Map<Eigen::RowVectorXd>(ranges.data(), bench::urg_beams);
    }
    recording.first_bearing = bench::urg_bearing(0);
    recording.step = bench::urg_step;
    bench::Random other(1);
    recording.geometry = std::move(bench::simulate(s.world, bench::noise_kind("3mm"), other).scan);
    return recording;
}

void write_log(const Simulation &s, int scans, double speed, const std::string &path)
{
    std::ofstream log(path);
    bench::Random random(5);
    for (int k = 0; k < scans; k++) {
        log << "ROBOTLASER1 2 -2.086213872 4.178563666 0.006135923 4.094 0.010 0 682";
        for (const double range : s.scan(random, speed * k)) {
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
        calibrate::read_recording(path);
    } catch (const std::runtime_error &e) {
        return e.what();
    }
    return "";
}

const Truth usual{{1500, 800, 2000, 2000, 12, 6000, 872665}, 0.3};

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
    ASSERT_EQ(ale_config_parse(calibrate::ini_fragment(c, "rest.log").c_str(), "fragment", &config, &error),
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
