#include "lab/bench/lines/stated_error.hpp"

#include <algorithm>

namespace bench
{
namespace
{

constexpr double same_beams = 0.6; // of the longer line

struct Surface {
    double first;
    double last;
    std::vector<Line> lines;

    bool shows(const Line &line) const
    {
        const double common = std::min<double>(line.last, last) - std::max<double>(line.first, first) + 1;
        return common >= same_beams * (std::max<double>(line.last - line.first, last - first) + 1);
    }
    void add(const Line &line)
    {
        lines.push_back(line);
        const double n = static_cast<double>(lines.size());
        first += (line.first - first) / n;
        last += (line.last - last) / n;
    }
    double squared_error() const
    {
        const double n = static_cast<double>(lines.size());
        double mean = 0; // from the first one, that angles do not wrap
        for (const Line &line : lines) {
            mean += wrapped(line.form.alpha - lines.front().form.alpha) / n;
        }
        double sum = 0;
        for (const Line &line : lines) {
            const double off = wrapped(line.form.alpha - lines.front().form.alpha) - mean;
            sum += off * off / (line.sigma_alpha * line.sigma_alpha);
        }
        return sum / (n - 1);
    }
};

std::vector<Surface> surfaces_of(const std::vector<std::vector<Line>> &scans)
{
    std::vector<Surface> all;
    for (const std::vector<Line> &scan : scans) {
        for (const Line &line : scan) {
            auto it = std::find_if(all.begin(), all.end(), [&](const Surface &s) { return s.shows(line); });
            if (it == all.end()) {
                it = all.insert(it, {static_cast<double>(line.first), static_cast<double>(line.last), {}});
            }
            it->add(line);
        }
    }
    return all;
}

} // namespace

StatedError stated_error(const std::vector<std::vector<Line>> &scans)
{
    std::vector<double> squared;
    for (const Surface &surface : surfaces_of(scans)) {
        if (2 * surface.lines.size() >= scans.size() && surface.lines.front().sigma_alpha > 0) {
            squared.push_back(surface.squared_error());
        }
    }
    std::sort(squared.begin(), squared.end());
    const int surfaces = static_cast<int>(squared.size());
    return surfaces == 0 ? StatedError{} : StatedError{surfaces, squared[squared.size() / 2], squared.back()};
}

} // namespace bench
