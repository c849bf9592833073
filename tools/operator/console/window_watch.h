/* Dirt on the scanner's window: neighbouring beams that give no range while the robot turns.
 *
 * The scanner does not report dirt. What it reports of a beam, too weak, disturbed or too near, may lie with
 * what the beam meets; where it stays the same through a hundred scans and a quarter of a turn it lies with
 * the beam. Beams that meet nothing in reach, or that are masked, say nothing about the window. */
#ifndef CONSOLE_WINDOW_WATCH_H
#define CONSOLE_WINDOW_WATCH_H

#include <cstdint>
#include <optional>
#include <vector>

#include "ale/scan_t.hpp"

namespace console
{

/* The widest run of such beams: how many, and where its middle lies in the robot's frame, radians. */
struct Stain {
    int beams;
    double bearing;
};

class WindowWatch
{
  public:
    /* A scan that was taken while the robot was at this heading, radians. */
    void scan(const ale::scan_t &scan, double heading);

    std::optional<Stain> stain() const;

  private:
    struct Beam {
        int scans = 0;
        double least_turn = 0;
        double most_turn = 0;
    };

    bool is_stained(const Beam &beam) const;

    std::vector<Beam> beams_;
    double turn_ = 0; /* the heading, without jumps at half a turn */
    double first_bearing_ = 0;
    double step_ = 0;
};

} // namespace console

#endif
