#include "lab/sim/device/sensors.h"

#include <vector>

namespace sim
{

namespace
{

constexpr double bits_a_byte = 10;

int64_t line_time_us(int bytes, double baud)
{
    return static_cast<int64_t>(bytes * bits_a_byte * 1e6 / baud);
}

/* LDROBOT's data sheets: 0.02 to 12 m, 4500 measurements a second, 5000 of the STL-19P, 10 turns a second. */
Sensor ldrobot(const char *name, double points_a_second)
{
    Sensor sensor = {name, SensorFamily::ldrobot, "ld06", {}, {}, {}};
    sensor.rotary.points_a_second = points_a_second;
    sensor.rotary.line_us = line_time_us(47, 230400);
    return sensor;
}

/* SLAMTEC's data sheets. The scan is the model's usual one. */
Sensor rplidar(const char *name, const char *noise, const RplidarModel &model, double min_m)
{
    Sensor sensor = {name, SensorFamily::rplidar, noise, {}, {}, model};
    sensor.rotary.points_a_second = 1e6 / model.express_us;
    sensor.rotary.packet_points = model.typical == RplidarScan::dense ? 40 : 32;
    sensor.rotary.min_mm = static_cast<int32_t>(min_m * 1000);
    sensor.rotary.max_mm = model.max_m * 1000;
    sensor.rotary.line_us = line_time_us(84, model.baud);
    if (model.typical == RplidarScan::standard) {
        sensor.rotary.packet_points = 1;
        sensor.rotary.line_us = line_time_us(5, model.baud);
    }
    return sensor;
}

/* Hokuyo's data sheets: 270 degrees in steps of a quarter, 40 turns a second. */
Sensor hokuyo_270(const char *name, const char *noise, const char *model, const char *product, int32_t min_mm,
                  int32_t max_mm)
{
    Sensor sensor = {name, SensorFamily::urg, noise, {}, {}, {}};
    sensor.scanner.model = model;
    sensor.scanner.product = product;
    sensor.scanner.firmware = "1.00";
    sensor.scanner.min_mm = min_mm;
    sensor.scanner.max_mm = max_mm;
    sensor.scanner.turn_steps = 1440;
    sensor.scanner.first_step = 0;
    sensor.scanner.last_step = 1080;
    sensor.scanner.front_step = 540;
    sensor.scanner.end_step = 1080;
    sensor.scanner.rpm = 2400;
    sensor.scanner.tells_state = true;
    return sensor;
}

const std::vector<Sensor> &sensors()
{
    static const std::vector<Sensor> all = {
        {"urg-04lx", SensorFamily::urg, "real", {}, {}, {}},
        hokuyo_270("utm-30lx", "utm-30lx", "UTM-30LX[Hokuyo Automatic Co.,Ltd.]",
                   "SOKUIKI Sensor TOP-URG UTM-30LX", 23, 60000),
        hokuyo_270("utm-30lx-ew", "utm-30lx", "UTM-30LX-EW[Hokuyo Automatic Co.,Ltd.]",
                   "SOKUIKI Sensor TOP-URG UTM-30LX-EW", 23, 60000),
        hokuyo_270("ust-10lx", "ust-10lx", "UST-10LX", "UST-10LX", 20, 30000),
        ldrobot("ld06", 4500),
        ldrobot("ld19", 4500),
        ldrobot("stl-19p", 5000),
        rplidar("rplidar-a1", "rplidar-a1",
                {0x18, 0x0114, 5, 115200, RplidarScan::express, false, false, 500, 250, 12}, 0.15),
        rplidar("rplidar-a2", "rplidar-a1",
                {0x28, 0x011d, 5, 115200, RplidarScan::express, true, true, 500, 250, 12}, 0.15),
        rplidar("rplidar-c1", "ld06",
                {0x41, 0x0101, 18, 460800, RplidarScan::standard, true, false, 200, 200, 12}, 0.05),
        rplidar("rplidar-s2", "ld06",
                {0x71, 0x0103, 18, 1000000, RplidarScan::dense, true, true, 500, 31.25, 30}, 0.05),
    };
    return all;
}

} // namespace

std::optional<Sensor> sensor_named(const std::string &name)
{
    for (const Sensor &sensor : sensors()) {
        if (name == sensor.name) {
            return sensor;
        }
    }
    return std::nullopt;
}

std::string sensor_names()
{
    std::string names;
    for (const Sensor &sensor : sensors()) {
        names += (names.empty() ? "" : ", ") + std::string(sensor.name);
    }
    return names;
}

} // namespace sim
