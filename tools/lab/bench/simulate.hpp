// A scanner in a world, a URG-04LX or one of a whole turn: one scan with its noise, and what each beam really
// hit.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lab/bench/world.hpp"

extern "C" {
#include "base/scan.h"
}

namespace bench
{

// Standard deviations in metres and radians; shares are probabilities.
struct Noise {
    std::string name;
    double own_floor = 0; // s_own = max(floor, proportional * d) ...
    double own_proportional = 0;
    bool own_in_square = false; // ... or the root of the sum of their squares
    double shared_constant = 0; // the part that neighbours share, likewise
    double shared_proportional = 0;
    double shared_beams = 12; // its correlation falls to 1/e over so many beams
    double surface = 0;       // bias of a whole surface
    double bearing = 0;
    double mixed = 0;   // share of depth edges with a mixed pixel
    double dropout = 0; // share of beams without a value
    double gross = 0;   // share of beams with a value from anywhere

    double own_sigma(double range) const;
    double shared_sigma(double range) const;
    double sigma(double range) const; // of one range, all parts together
};

// urg, dirty, 3mm, 10mm, 20mm, real.
const std::vector<Noise> &noise_kinds();
const Noise &noise_kind(const std::string &name);

// What the ray of a beam meets without noise. Walls come first in the count of surfaces, then arcs.
struct Hit {
    int surface = -1; // -1: nothing
    double range = 0;
};

Hit cast(const World &world, double bearing);

// Bearing of a beam of the URG-04LX in the sensor's frame.
double urg_bearing(int beam);

constexpr int urg_beams = 682;
constexpr double urg_step = 2 * pi / 1024;
constexpr double urg_reach = 4.094;

// How the beams of a scanner lie, counter-clockwise, and how far they see.
struct Sensor {
    int beams = urg_beams;
    int front = 340; // beam that looks straight ahead
    double step = urg_step;
    double reach = urg_reach;

    double bearing(int beam) const
    {
        return (beam - front) * step;
    }
};

// A whole turn of so many beams, which begins where one surface ends and another begins: no wall lies across
// its seam.
Sensor whole_turn(const World &world, int beams, double reach);

struct SimulatedScan {
    Sensor sensor;
    std::unique_ptr<ale_scan_t> scan;
    std::vector<Hit> hits;   // without noise
    std::vector<bool> clean; // the beam has a value, of the surface it hit
};

SimulatedScan simulate(const World &world, const Noise &noise, Random &random, const Sensor &sensor = {});

// The same turn from beam `seam` on, counter-clockwise or not.
std::unique_ptr<ale_scan_t> turned(const ale_scan_t &scan, int seam, bool clockwise);

} // namespace bench
