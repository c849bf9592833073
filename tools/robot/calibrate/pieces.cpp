#include "robot/calibrate/pieces.h"

#include <cmath>

namespace mounting
{

namespace
{

constexpr double longest = 10; /* seconds for a piece: it hardly moved */
/* Metres and radians together. Shorter pieces drown the turn in the error of headings, which stands in the
 * regressors too and would bias the factor of turns. */
constexpr double length = 1.5;

Eigen::Vector2d rotated(double x, double y, double angle)
{
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * x - s * y, s * x + c * y};
}

/* Displacement in the frame halfway between two headings. */
Eigen::Vector2d halfway(const Pose &a, const Pose &b)
{
    return rotated(b.x() - a.x(), b.y() - a.y(), -(a.z() + b.z()) / 2);
}

/* As the firmware judges: twice what the robot can do, and a little. */
bool jumps(const Drive &drive, const WheelPose &a, const WheelPose &b)
{
    const double time = b.time - a.time;
    const Pose d = b.pose - a.pose;
    return d.head<2>().norm() > 2 * drive.most_speed * time + 0.05 ||
           std::fabs(d.z()) > 2 * drive.most_turn_rate * time + 0.1 || time > longest;
}

struct Step {
    Eigen::Vector2d way;
    double turn;
    /* Metres and radians together. */
    double effort() const
    {
        return way.norm() + std::fabs(turn);
    }
};

/* What the wheels counted from the sample before. */
Step step_to(const Drive &drive, size_t k)
{
    const Pose &a = drive.wheels[k - 1].pose;
    const Pose &b = drive.wheels[k].pose;
    return {halfway(a, b), b.z() - a.z()};
}

std::optional<Piece> piece_from(const Drive &drive, size_t first)
{
    Piece piece = {first, first, Eigen::Vector2d::Zero(), 0};
    double moved = 0;
    while (moved < length) {
        const size_t k = piece.last + 1;
        if (k >= drive.wheels.size() || jumps(drive, drive.wheels[k - 1], drive.wheels[k]) ||
            drive.wheels[k].time - drive.wheels[first].time > longest) {
            return std::nullopt;
        }
        const Step step = step_to(drive, k);
        piece.counted_way += step.way;
        piece.counted_turn += step.turn;
        piece.last = k;
        moved += step.effort();
    }
    return piece;
}

} // namespace

std::vector<Piece> cut(const Drive &drive)
{
    std::vector<Piece> pieces;
    double since = length;
    for (size_t k = 1; k < drive.wheels.size(); k++) {
        if (since >= length / overlap) {
            if (const auto piece = piece_from(drive, k - 1)) {
                pieces.push_back(*piece);
                since = 0;
            }
        }
        since += step_to(drive, k).effort();
    }
    return pieces;
}

std::optional<Seen> seen(const Drive &drive, const Piece &piece, double lag)
{
    std::optional<Pose> before = drive.laser.at(drive.wheels[piece.first].time + lag);
    Seen sum{Eigen::Vector2d::Zero(), 0, 0};
    for (size_t k = piece.first + 1; k <= piece.last; k++) {
        const std::optional<Pose> now = drive.laser.at(drive.wheels[k].time + lag);
        if (!before || !now) {
            return std::nullopt;
        }
        const double turn = now->z() - before->z();
        sum.way += halfway(*before, *now);
        sum.lever += 2 * std::sin(turn / 2);
        sum.turn += turn;
        before = now;
    }
    return sum;
}

} // namespace mounting
