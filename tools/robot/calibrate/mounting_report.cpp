#include "robot/calibrate/mounting_report.h"

#include <cmath>

#include "common/export/formatted.h"

namespace mounting
{

namespace
{

struct Line {
    Quantity quantity;
    int digits;
    double scale; /* from the fit's unit to the key's */
    const char *key;
    const char *meaning;
    const char *shows;
};

constexpr Line sensor_lines[] = {
    {X, 4, 1, "x", "metres ahead of the point the robot turns about", "in turns and in straight ways"},
    {Y, 4, 1, "y", "metres to its left", "in turns of both directions and in straight ways"},
    {THETA, 5, 1, "theta", "radians", "in straight ways"}};

constexpr Line odometry_lines[] = {
    {LAG, 0, 1e6, "lag_us", "microseconds by which the odometry is younger than the scans",
     "where turns begin and end, in scans that come at least three times a second"},
    {DISTANCE_FACTOR, 5, 1, "distance_factor", "true way of a metre counted", "in straight ways"},
    {TURN_FACTOR, 5, 1, "turn_factor", "true turn of a radian counted", "in turns"},
    {TURN_BIAS, 5, 1, "turn_bias", "radians counted on a straight metre", "in long straight ways"}};

std::string text_of(const Fit &fit, const Line &line)
{
    const Estimate &e = fit.estimate[static_cast<size_t>(line.quantity)];
    const double value = e.value * line.scale;
    const double sigma = e.sigma * line.scale;
    if (!e.determined) {
        return ale::formatted("# not determined by this drive (%.*f +- %.*f); it shows %s\n# %s =\n",
                              line.digits, value, line.digits, sigma, line.shows, line.key);
    }
    return ale::formatted("# +- %.*f  %s\n%s = %.*f\n", line.digits, sigma, line.meaning, line.key,
                          line.digits, value);
}

} // namespace

std::string configuration(const Fit &fit, const std::string &source, Part part)
{
    std::string text =
        "# Mounting, wheels and lag as ale-calibrate found them in " + source + ": " +
        ale::formatted("%.1f m and %.1f rad in %zu pieces,\n", fit.way, fit.turned, fit.pieces) +
        ale::formatted(
            "# %zu of them set aside (slip, wrong matches); a piece of the rest fits to %.1f mm and "
            "%.1f mrad. +- is one sigma.\n",
            fit.set_aside, fit.way_error * 1e3, fit.turn_error * 1e3);
    if (part != Part::wheels) {
        text += "\n[sensor]\n";
        for (const Line &line : sensor_lines) {
            text += text_of(fit, line);
        }
    }
    if (part != Part::mounting) {
        text += "\n[odometry]\n";
        for (const Line &line : odometry_lines) {
            text += text_of(fit, line);
        }
    }
    return text;
}

} // namespace mounting
