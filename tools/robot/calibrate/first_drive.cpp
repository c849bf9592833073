#include "robot/calibrate/first_drive.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "common/export/formatted.h"

namespace calibrate
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double degrees = 180 / pi;
constexpr double window = 0.5;      /* seconds, over which motions are compared */
constexpr double stride = 0.1;      /* from one to the next */
constexpr double straight = 0.12;   /* radians in a window, at most, of a way that counts as straight */
constexpr double least_way = 0.04;  /* metres in a window, of one that moves */
constexpr double enough_way = 0.8;  /* metres straight, */
constexpr double enough_turn = 1.2; /* radians of turns, before anything is said */
constexpr double lag_low = -0.3;
constexpr double lag_high = 1.0;
constexpr double lag_step = 0.02;
constexpr double late = 0.15; /* what the firmware extrapolates; half of what it makes up for */
constexpr double way_tolerance = 0.03;
constexpr double turn_tolerance = 0.05;

using Direction = std::complex<double>;

/* What is sent within one turn grows with the turns here; one turn is what it jumps by: 2 pi, or 360. */
std::vector<TimedPose> unwrapped(std::vector<TimedPose> poses)
{
    std::vector<double> steps;
    for (size_t k = 1; k < poses.size(); k++) {
        if (const double step = std::abs(poses[k].theta - poses[k - 1].theta); step > 0) {
            steps.push_back(step);
        }
    }
    if (steps.empty()) {
        return poses;
    }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double jump = std::max(4.0, 10 * *middle);
    double added = 0;
    double before = poses[0].theta;
    for (TimedPose &pose : poses) {
        const double step = pose.theta - before;
        before = pose.theta;
        if (std::abs(step) > jump) {
            const double turn = std::abs(step) > 180 ? 360 : 2 * pi;
            added -= std::copysign(turn, step);
        }
        pose.theta += added;
    }
    return poses;
}

std::optional<TimedPose> at(const std::vector<TimedPose> &poses, double time)
{
    const auto after = std::upper_bound(poses.begin(), poses.end(), time,
                                        [](double t, const TimedPose &p) { return t < p.time; });
    if (after == poses.begin() || after == poses.end() || after->time - (after - 1)->time > window) {
        return std::nullopt;
    }
    const TimedPose &a = *(after - 1);
    const double u = (time - a.time) / (after->time - a.time);
    return TimedPose{time, a.x + u * (after->x - a.x), a.y + u * (after->y - a.y),
                     a.theta + u * (after->theta - a.theta)};
}

/* One window: both motions and headings in its middle. */
struct Piece {
    Direction seen_way;
    Direction counted_way;
    double seen_turn;
    double counted_turn;
    double seen_heading;
    double counted_heading;

    bool is_straight() const
    {
        return std::abs(seen_turn) < straight && std::abs(seen_way) > least_way;
    }
};

std::vector<Piece> pieces_at(const std::vector<TimedPose> &seen, const std::vector<TimedPose> &counted,
                             double lag)
{
    std::vector<Piece> pieces;
    if (seen.empty()) {
        return pieces;
    }
    for (double time = seen.front().time; time + window < seen.back().time; time += stride) {
        const auto a = at(seen, time);
        const auto b = at(seen, time + window);
        const auto c = at(counted, time + lag);
        const auto d = at(counted, time + window + lag);
        if (a && b && c && d) {
            pieces.push_back({{b->x - a->x, b->y - a->y},
                              {d->x - c->x, d->y - c->y},
                              b->theta - a->theta,
                              d->theta - c->theta,
                              (a->theta + b->theta) / 2,
                              (c->theta + d->theta) / 2});
        }
    }
    return pieces;
}

/* What one tells of the other: by least squares, and how well, 0 to 1. */
struct Ratio {
    double ratio = 0;
    double agreement = 0;
};

Ratio turn_ratio(const std::vector<Piece> &pieces)
{
    double ss = 0;
    double sc = 0;
    double cc = 0;
    for (const Piece &p : pieces) {
        ss += p.seen_turn * p.seen_turn;
        sc += p.seen_turn * p.counted_turn;
        cc += p.counted_turn * p.counted_turn;
    }
    return ss > 0 && cc > 0 ? Ratio{sc / ss, sc * sc / (ss * cc)} : Ratio{};
}

double lag_of(const std::vector<TimedPose> &seen, const std::vector<TimedPose> &counted)
{
    double best = -1;
    double lag = 0;
    for (double tried = lag_low; tried < lag_high; tried += lag_step) {
        const double agreement = turn_ratio(pieces_at(seen, counted, tried)).agreement;
        if (agreement > best) {
            best = agreement;
            lag = tried;
        }
    }
    return lag;
}

double way_ratio(const std::vector<Piece> &pieces)
{
    double ss = 0;
    double sc = 0;
    for (const Piece &p : pieces) {
        if (p.is_straight()) {
            ss += std::norm(p.seen_way);
            sc += std::abs(p.seen_way) * std::abs(p.counted_way);
        }
    }
    return ss > 0 ? sc / ss : 0;
}

bool is_about(double value, double what)
{
    return value > 0.7 * what && value < 1.4 * what;
}

Finding judge_way(double ratio)
{
    if (ratio < 0.02) {
        return {"way", false, "the wheels count no way: x and y hardly change"};
    }
    if (is_about(ratio, 1000)) {
        return {"way", false, "x and y are in millimetres: metres are wanted"};
    }
    if (is_about(ratio, 100)) {
        return {"way", false, "x and y are in centimetres: metres are wanted"};
    }
    const bool fine = std::abs(ratio - 1) < way_tolerance;
    return {
        "way", fine,
        ale::formatted(
            "the wheels count %.3f of what the scans see%s", ratio,
            fine ? ""
                 : ale::formatted("; scale: %.3f times the ticks per metre would be right", ratio).c_str())};
}

Finding judge_turns(double ratio)
{
    const std::string sign =
        ratio < 0 ? "the sign is wrong: a turn to the left must count up (left and right wheel exchanged?)"
                  : "";
    const double size = std::abs(ratio);
    const std::string and_sign = sign.empty() ? "" : "; " + sign;
    if (size < 0.02) {
        return {"turns", false, "the wheels count no turns: theta hardly changes"};
    }
    if (is_about(size, degrees)) {
        return {"turns", false, "theta is in degrees: radians are wanted" + and_sign};
    }
    if (!sign.empty()) {
        return {"turns", false, sign};
    }
    const bool fine = std::abs(size - 1) < turn_tolerance;
    return {"turns", fine,
            ale::formatted(
                "the wheels count %.3f of what the scans see%s", size,
                fine ? "" : ale::formatted("; scale: %.3f times the track would be right", size).c_str())};
}

/* Where the ways point when each is turned back by the sender's heading, once taken as it is (by: -1), once
 * as if it counted the other way round (by: 1). The length tells how well they agree. */
Direction direction_of(const std::vector<Piece> &pieces, double unit, double by)
{
    Direction sum = 0;
    double count = 0;
    for (const Piece &p : pieces) {
        if (p.is_straight() && std::abs(p.counted_way) > 0) {
            const double ahead = std::arg(p.seen_way) - p.seen_heading; /* half a turn: it drives backwards */
            sum += std::polar(1.0, std::arg(p.counted_way) + by * p.counted_heading / unit - ahead);
            count++;
        }
    }
    return count > 0 ? sum / count : 0;
}

Finding judge_axes(const std::vector<Piece> &pieces, double turns)
{
    const double unit = is_about(std::abs(turns), degrees) ? degrees : 1;
    const Direction usual = direction_of(pieces, unit, -1);
    const Direction mirrored = direction_of(pieces, unit, 1);
    const bool is_mirrored = std::abs(mirrored) > std::abs(usual) + 0.05;
    const Direction direction = is_mirrored ? mirrored : usual;
    const double angle = std::arg(direction) * degrees;
    constexpr double quarter = 30; /* degrees beside a right angle that still are one */
    if (std::abs(direction) < 0.7) {
        return {"axes", false,
                "x and y do not go where theta points: they must be sums in a frame that stands still"};
    }
    if (std::abs(std::abs(angle) - 90) < quarter) {
        return {"axes", false, "the axes are swapped: forward counts as y; x is ahead, y to the left"};
    }
    if (std::abs(angle) > 180 - quarter) {
        return {"axes", false, "the sign is wrong: forward counts backward"};
    }
    if (is_mirrored) {
        return {"axes", false,
                turns < 0 ? "theta counts the other way round than x and y go"
                          : "the sign of y is wrong: y counts to the left"};
    }
    const bool fine = std::abs(angle) < quarter;
    return {"axes", fine, ale::formatted("forward points %.0f degrees to the left of theta", angle + 0.0)};
}

Finding judge_time(double lag)
{
    const bool fine = lag < late && lag > -late;
    return {"time", fine,
            ale::formatted(
                "odometry comes %.2f s %s the scans that saw the same%s", std::abs(lag),
                lag < 0 ? "before" : "after",
                fine ? "" : "; late: 0.15 s is made up for: send it at once, 20 times a second or more")};
}

std::string still_missing(const std::vector<Piece> &pieces)
{
    double way = 0;
    double turn = 0;
    for (const Piece &p : pieces) {
        way += p.is_straight() ? std::abs(p.seen_way) * stride / window : 0;
        turn += std::abs(p.seen_turn) * stride / window;
    }
    std::string missing;
    if (way < enough_way) {
        missing += ale::formatted("%.1f m straight ahead", enough_way - way);
    }
    if (turn < enough_turn) {
        missing += (missing.empty() ? "" : ", ") +
                   ale::formatted("%.0f degrees of turns", (enough_turn - turn) * degrees);
    }
    return missing;
}

} // namespace

Verdict judge(const FirstDrive &drive)
{
    Verdict verdict;
    const std::vector<TimedPose> seen = unwrapped(drive.seen);
    const std::vector<TimedPose> counted = unwrapped(drive.counted);
    verdict.missing = still_missing(pieces_at(seen, seen, 0));
    if (counted.size() < 2) {
        verdict.findings.push_back({"odometry", false, "nothing is heard on ALE_ODOMETRY"});
        return verdict;
    }
    const double lag = lag_of(seen, counted);
    const std::vector<Piece> pieces = pieces_at(seen, counted, lag);
    const double turns = turn_ratio(pieces).ratio;
    const double way = way_ratio(pieces);
    verdict.findings.push_back(judge_way(way));
    verdict.findings.push_back(judge_turns(turns));
    if (way >= 0.02) {
        verdict.findings.push_back(judge_axes(pieces, turns));
    }
    if (std::abs(turns) >= 0.02) {
        verdict.findings.push_back(judge_time(lag));
    }
    return verdict;
}

} // namespace calibrate
