#include "robot/calibrate/noise_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/export/formatted.h"
#include "robot/calibrate/rest.h"

namespace calibrate
{

namespace
{

constexpr size_t least_walls = 3; /* fewer biases say nothing of their spread */
constexpr double well_known =
    0.5; /* largest variance of one bias by its own error, as a part of their mean square */
constexpr double reference_range = 2;
constexpr double shortest_shared_beams = 3;

int32_t rounded_sqrt(double variance, double units)
{
    const double value = std::round(std::sqrt(std::max(variance, 0.0)) * units);
    return static_cast<int32_t>(std::min<double>(value, std::numeric_limits<int32_t>::max()));
}

/* What only next neighbours share is the device's own averaging: on a run of beams it acts like the noise of
 * each beam's own, and counts with it. */
TemporalFit without_averaging(TemporalFit fit)
{
    if (fit.length < shortest_shared_beams) {
        fit.own += fit.shared;
        fit.own_relative += fit.shared_relative;
        fit.shared = fit.shared_relative = 0;
    }
    return fit;
}

/* Both parts that neighbours share fade over beams; their length is the mean, weighted by variance. */
double common_length(const TemporalFit &temporal, const LastingFit &lasting)
{
    const double square = reference_range * reference_range;
    const double changing = temporal.shared + temporal.shared_relative * square;
    const double steady = lasting.shared + lasting.shared_relative * square;
    const double sum = changing + steady;
    return sum > 0 ? (changing * temporal.length + steady * lasting.length) / sum
                   : ale_noise_default().shared_beams;
}

ale_noise_t noise_of(const TemporalFit &temporal, const LastingFit &lasting, bool surface_known)
{
    ale_noise_t noise{};
    noise.own_um = rounded_sqrt(temporal.own + lasting.own, 1e6);
    noise.own_ppm = rounded_sqrt(temporal.own_relative, 1e6);
    noise.shared_um = rounded_sqrt(temporal.shared + lasting.shared, 1e6);
    noise.shared_ppm = rounded_sqrt(temporal.shared_relative + lasting.shared_relative, 1e6);
    noise.shared_beams = static_cast<int32_t>(std::max(1L, std::lround(common_length(temporal, lasting))));
    noise.surface_um = surface_known ? rounded_sqrt(lasting.surface, 1e6) : ale_noise_default().surface_um;
    noise.bearing_nrad = rounded_sqrt(temporal.bearing, 1e9);
    return noise;
}

std::string shared_at_reference(double constant, double relative, double length)
{
    const double variance = constant + relative * reference_range * reference_range;
    return ale::formatted("%.1f mm over %.1f beams", 1e3 * std::sqrt(variance), length);
}

} // namespace

Calibration calibrate(const Recording &recording)
{
    Calibration c;
    c.scans = recording.scans();
    c.beams = beams_of(recording);
    require_rest(recording, c.beams);
    c.products = deviation_products(recording, c.beams);
    c.temporal = fit_temporal(c.beams, c.products);
    c.lasting = fit_lasting(recording, c.beams, c.temporal);
    c.mixed = count_mixed_pixels(recording, c.beams);
    c.surface_known =
        c.lasting.walls.size() >= least_walls && c.lasting.bias_variance < well_known * c.lasting.surface;
    c.noise = noise_of(without_averaging(c.temporal), c.lasting, c.surface_known);
    return c;
}

std::string shared_in_words(const Calibration &c)
{
    const TemporalFit &changing = c.temporal;
    const LastingFit &steady = c.lasting;
    return "neighbours share, at 2 m: " +
           shared_at_reference(changing.shared, changing.shared_relative, changing.length) +
           " that change from scan to scan, and " +
           shared_at_reference(steady.shared, steady.shared_relative, steady.length) + " that last";
}

std::string configuration(const Calibration &c, const std::string &source)
{
    const auto entry = [](const char *key, int32_t value) {
        return std::string(key) + " = " + std::to_string(value) + "\n";
    };
    std::string text = "; fitted by ale-calibrate to " + source + ", " + std::to_string(c.scans) +
                       " scans\n; " + shared_in_words(c) + "\n" +
                       ale::formatted("; mixed pixels in %.1f %% of the scans of %d depth edges\n",
                                      100 * c.mixed.share, c.mixed.edges);
    text += c.surface_known
                ? "; surface_um: from the biases of " + std::to_string(c.lasting.walls.size()) + " walls\n"
                : "; surface_um: too few walls seen under a wide angle, the default is kept\n";
    text += "[noise]\n";
    text += entry("own_um", c.noise.own_um) + entry("own_ppm", c.noise.own_ppm);
    text += entry("shared_um", c.noise.shared_um) + entry("shared_ppm", c.noise.shared_ppm);
    text += entry("shared_beams", c.noise.shared_beams) + entry("surface_um", c.noise.surface_um);
    return text + entry("bearing_nrad", c.noise.bearing_nrad);
}

} // namespace calibrate
