// What is really there to be found in a simulated scan, in the sensor's frame.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lab/bench/simulate.hpp"

namespace bench
{

// The visible piece of a wall: a run of beams without anything in between.
struct TrueLine {
    int wall = 0;
    int first = 0;
    int last = 0;
    int points = 0; // clean beams
    Point start = Point::Zero();
    Point end = Point::Zero();
    NormalForm form; // rho >= 0: the normal points away from the sensor
    // Where the piece may begin and end, as positions along the tangent: from the outermost beam that
    // met it to where the next beam would have, or to the end of the wall.
    std::array<double, 2> start_between{};
    std::array<double, 2> end_between{};
    std::array<double, 3> information{}; // of (alpha, rho): aa, ar, rr; what the noise allows at best
    bool counts = false;                 // long enough to be demanded
};

struct TrueCorner {
    Point p = Point::Zero();
    double angle = 0; // radians
    bool counts = false;
};

struct Truth {
    std::string kind;
    std::vector<TrueLine> lines;
    std::vector<TrueCorner> corners;
};

constexpr int least_true_beams = 10;
constexpr double least_true_length = 0.15;

Truth make_truth(const World &world, const Noise &noise, const SimulatedScan &scan);

} // namespace bench
