/* Scans and maps that cost much: a few numbers describe one, so that a search can change them. */
#ifndef BENCH_WCET_SCANS_HPP
#define BENCH_WCET_SCANS_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lab/bench/random.hpp"

extern "C" {
#include "track/pipeline.h"
}

namespace bench
{

int32_t micrometres(double metres);

struct Costly {
    int beams = ALE_MAX_BEAMS;
    double base_m = 3;       /* distance of the walls */
    double tooth_m = 0.5;    /* depth of the zigzag */
    double tooth_beams = 20; /* beams from tip to tip */
    double square = 0;       /* 0 zigzag .. 1 steps: corners that jump */
    double noise_m = 0.004;  /* of each beam, one sigma */
    double dropped = 0;      /* part of the beams that bring nothing */
    double turn_rad_s = 0;   /* the robot turns: every scan is straightened */
    double map_walls = 0;    /* a known map of so many walls, all near, loaded before */
    double jump_rad = 0;     /* after a while the scene turns so far at once, */
    double gap_s = 0;        /* after as long without a scan: lost, and sought */

    std::string words() const;
};

/* One of the numbers made larger or smaller, within what a scanner can see. */
Costly changed(const Costly &from, Random &random);

/* What its wheels tell in the tenth of a second before scan number k. */
std::vector<ale_odometry_t> wheels_before(const Costly &costly, int k);

/* Scan number k of a robot that stands in it. */
ale_scan_t scan_of(const Costly &costly, int k, Random &random);

/* The known map around it; empty without walls. */
std::unique_ptr<ale_map_t> map_of(const Costly &costly, Random &random);

/* A scan of full size of anything between walls and noise. */
ale_scan_t any_scan(Random &random);

/* Scans with the ranges of a robot that sees through every wall. */
ale_scan_t far_scan(Random &random);

} // namespace bench

#endif
