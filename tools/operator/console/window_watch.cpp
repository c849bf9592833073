#include "operator/console/window_watch.h"

#include <algorithm>
#include <cmath>

namespace console
{

namespace
{

constexpr int enough_scans = 100;
constexpr double enough_turn = 1.5;
constexpr int fewest_beams = 6; /* two degrees of an URG: fewer are no dirt worth a word */

/* Codes: below 128 the scanner's own, else 128 + flag of lib/base/scan.h. */
bool is_trouble(int code)
{
    constexpr int farthest = 6; /* as 0: nothing in reach */
    constexpr int no_beam = 19;
    constexpr int unusable = 130;
    constexpr int too_near = 133;
    const bool device = code > 0 && code < no_beam && code != farthest;
    return device || code == unusable || code == too_near;
}

} // namespace

void WindowWatch::scan(const ale::scan_t &scan, double heading)
{
    first_bearing_ = static_cast<double>(scan.sensor_theta) + static_cast<double>(scan.first_bearing);
    step_ = static_cast<double>(scan.step);
    turn_ += std::remainder(heading - turn_, 2 * M_PI);
    if (scan.codes.size() != beams_.size()) {
        beams_.assign(scan.codes.size(), {0, turn_, turn_});
    }
    for (size_t k = 0; k < beams_.size(); k++) {
        Beam &beam = beams_[k];
        if (!is_trouble(scan.codes[k])) {
            beam = {0, turn_, turn_};
            continue;
        }
        beam.scans++;
        beam.least_turn = std::min(beam.least_turn, turn_);
        beam.most_turn = std::max(beam.most_turn, turn_);
    }
}

bool WindowWatch::is_stained(const Beam &beam) const
{
    return beam.scans >= enough_scans && beam.most_turn - beam.least_turn >= enough_turn;
}

std::optional<Stain> WindowWatch::stain() const
{
    size_t widest = 0;
    size_t last = 0;
    size_t run = 0;
    for (size_t k = 0; k < beams_.size(); k++) {
        run = is_stained(beams_[k]) ? run + 1 : 0;
        if (run > widest) {
            widest = run;
            last = k;
        }
    }
    if (widest < fewest_beams) {
        return std::nullopt;
    }
    const double middle = static_cast<double>(last) - static_cast<double>(widest - 1) / 2;
    return Stain{static_cast<int>(widest), std::remainder(first_bearing_ + middle * step_, 2 * M_PI)};
}

} // namespace console
