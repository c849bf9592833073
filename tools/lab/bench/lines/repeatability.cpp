#include "lab/bench/lines/repeatability.hpp"

#include <algorithm>
#include <set>

namespace bench
{
namespace
{

constexpr double same_direction = radians(3);
constexpr double same_distance = 0.04;
constexpr int longest_memory = 50; // scans over which a group's mean follows

struct Member {
    std::size_t scan;
    int first;
    int last;
};

struct Group {
    NormalForm form;
    double first;
    double last;
    std::vector<Member> members;

    // How unlike a line is; negative: it does not belong here.
    double unlike(const Line &line) const
    {
        const double common = std::min<double>(line.last, last) - std::max<double>(line.first, first) + 1;
        const double shorter = std::min<double>(line.last - line.first, last - first) + 1;
        const double da = std::abs(wrapped(line.form.alpha - form.alpha));
        const double dr = std::abs(line.form.rho - form.rho);
        const bool alike = common >= shorter / 2 && da < same_direction && dr < same_distance;
        return alike ? da / same_direction + dr / same_distance : -1;
    }
    void add(std::size_t scan, const Line &line)
    {
        members.push_back({scan, line.first, line.last});
        const double weight = 1.0 / std::min<double>(longest_memory, static_cast<double>(members.size()));
        form.alpha = wrapped(form.alpha + weight * wrapped(line.form.alpha - form.alpha));
        form.rho += weight * (line.form.rho - form.rho);
        first += weight * (line.first - first);
        last += weight * (line.last - last);
    }
    std::size_t scans() const
    {
        std::set<std::size_t> seen;
        for (const Member &m : members) {
            seen.insert(m.scan);
        }
        return seen.size();
    }
};

Group *most_alike(std::vector<Group> &groups, const Line &line)
{
    Group *best = nullptr;
    double least = 0;
    for (Group &group : groups) {
        const double unlike = group.unlike(line);
        if (unlike >= 0 && (best == nullptr || unlike < least)) {
            best = &group;
            least = unlike;
        }
    }
    return best;
}

std::vector<Group> grouped(const std::vector<std::vector<Line>> &scans)
{
    std::vector<Group> groups;
    for (std::size_t s = 0; s < scans.size(); s++) {
        for (const Line &line : scans[s]) {
            if (line.last - line.first + 1 < 8) {
                continue;
            }
            Group *group = most_alike(groups, line);
            if (group == nullptr) {
                groups.push_back(
                    {line.form, static_cast<double>(line.first), static_cast<double>(line.last), {}});
                group = &groups.back();
            }
            group->add(s, line);
        }
    }
    return groups;
}

double median(std::vector<double> values)
{
    if (values.empty()) {
        return std::nan("");
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double scatter(const std::vector<Member> &members, int Member::*end)
{
    double mean = 0;
    double square = 0;
    for (const Member &m : members) {
        mean += m.*end;
        square += static_cast<double>(m.*end) * (m.*end);
    }
    const double n = static_cast<double>(members.size());
    return std::sqrt(std::max(0.0, square / n - (mean / n) * (mean / n)));
}

// Pieces of a wall would say more of its cuts than of its ends: those under half its length are left out.
std::vector<Member> whole_ones(const Group &group)
{
    std::vector<double> lengths;
    for (const Member &m : group.members) {
        lengths.push_back(m.last - m.first);
    }
    const double half = median(lengths) / 2;
    std::vector<Member> whole;
    std::copy_if(group.members.begin(), group.members.end(), std::back_inserter(whole),
                 [&](const Member &m) { return m.last - m.first >= half; });
    return whole;
}

} // namespace

Repeatability repeatability(const std::vector<std::vector<Line>> &scans)
{
    Repeatability result;
    std::vector<double> ends;
    std::size_t stray = 0;
    const double count = static_cast<double>(scans.size());
    for (const Group &group : grouped(scans)) {
        const double seen = static_cast<double>(group.scans());
        if (seen < count / 2) {
            stray += group.members.size();
            continue;
        }
        result.walls++;
        result.seen += 100 * seen / count;
        result.pieces += static_cast<double>(group.members.size()) / seen;
        const std::vector<Member> whole = whole_ones(group);
        ends.push_back(scatter(whole, &Member::first));
        ends.push_back(scatter(whole, &Member::last));
    }
    result.seen /= std::max(1, result.walls);
    result.pieces /= std::max(1, result.walls);
    result.stray = static_cast<double>(stray) / count;
    result.end_rms = median(ends);
    return result;
}

} // namespace bench
