#include "reference/wall_match.h"

namespace reference
{
namespace
{

constexpr double least_share = 0.4;   // of the shorter of the two must be common,
constexpr double least_common = 0.06; // and so much in metres,
constexpr double enough_share = 0.8;  // but no more than this share of it
constexpr double always_near = 0.03;  // metres that no covariance makes too far
constexpr double always_parallel = 0.05;
constexpr double wall_variance_floor = 1e-8;
constexpr WallGate scoring = {0.12, 0.12, 1000};

Eigen::Vector2d normal_of(double angle)
{
    return {std::cos(angle), std::sin(angle)};
}

Eigen::Vector2d tangent_of(double angle)
{
    return {std::sin(angle), -std::cos(angle)};
}

struct Comparison {
    double offset;
    double angle;
    double along; // the line's centre on the wall
    double common;
};

Comparison compare(const WallPiece &wall, const WallPiece &line, const Pose &pose)
{
    const Eigen::Vector2d seen = pose.head<2>() + rotation(pose[2]) * line.centre - wall.centre;
    const double along = seen.dot(tangent_of(wall.normal));
    return {seen.dot(normal_of(wall.normal)), wrap(line.normal + pose[2] - wall.normal), along,
            std::min(wall.end, along + line.end) - std::max(wall.start, along + line.start)};
}

double offset_variance(const WallPiece &wall, double along)
{
    return std::max(wall.var_offset + 2 * along * wall.cov_offset_angle + along * along * wall.var_angle,
                    wall_variance_floor);
}

// Derivative of a point's offset by the pose's error in the robot's frame: n, and n against the turned point.
double offset_variance(const WallPiece &line, const Eigen::Matrix3d &cov)
{
    const Eigen::Vector2d n = normal_of(line.normal);
    const Eigen::Vector2d turned(-line.centre.y(), line.centre.x());
    const Eigen::Vector3d row(n.x(), n.y(), n.dot(turned));
    return row.dot(cov * row);
}

// Squared distance in sigmas, or infinite.
double distance(const WallPiece &wall, const WallPiece &line, const Pose &pose, const Eigen::Matrix3d &cov,
                const WallGate &gate, Decisions &decisions)
{
    const Comparison c = compare(wall, line, pose);
    const double shorter = std::min(wall.end - wall.start, line.end - line.start);
    const double needed = std::min(std::max(least_share * shorter, least_common), enough_share * shorter);
    if (!decisions.below(std::fabs(c.angle), gate.angle) ||
        !decisions.below(std::fabs(c.offset), gate.offset) || decisions.below(c.common, needed)) {
        return HUGE_VAL;
    }
    const double var_offset = offset_variance(wall, c.along) + line.var_offset + offset_variance(line, cov);
    const double var_angle = wall.var_angle + line.var_angle + cov(2, 2);
    const double offset2 = c.offset * c.offset / var_offset;
    const double angle2 = c.angle * c.angle / var_angle;
    const double most = gate.sigmas * gate.sigmas;
    const bool too_far = std::fabs(c.offset) > always_near && !decisions.below(offset2, most);
    const bool too_turned = std::fabs(c.angle) > always_parallel && !decisions.below(angle2, most);
    return too_far || too_turned ? HUGE_VAL : offset2 + angle2;
}

} // namespace

int wall_shown(const std::vector<WallPiece> &map, const WallPiece &line, const Pose &pose,
               const Eigen::Matrix3d &cov, const WallGate &gate, Decisions &decisions)
{
    int best = -1;
    double least = HUGE_VAL;
    for (size_t k = 0; k < map.size(); k++) {
        const double d = distance(map[k], line, pose, cov, gate, decisions);
        if (d < HUGE_VAL && decisions.below(d, least)) {
            least = d;
            best = static_cast<int>(k);
        }
    }
    return best;
}

Pose pose_of_pair(const WallPiece &a, const WallPiece &b, const WallPiece &wall_a, const WallPiece &wall_b)
{
    const double turn_a = wall_a.normal - a.normal;
    const double heading = turn_a + wrap(wall_b.normal - b.normal - turn_a) / 2;
    Eigen::Matrix2d normals;
    normals.row(0) = normal_of(wall_a.normal);
    normals.row(1) = normal_of(wall_b.normal);
    const Eigen::Vector2d offsets(normal_of(wall_a.normal).dot(wall_a.centre - rotation(heading) * a.centre),
                                  normal_of(wall_b.normal).dot(wall_b.centre - rotation(heading) * b.centre));
    const Eigen::Vector2d p = normals.inverse() * offsets;
    return {p.x(), p.y(), heading};
}

double length_on_walls(const std::vector<WallPiece> &map, const std::vector<WallPiece> &lines,
                       const Pose &pose, Decisions &decisions)
{
    double sum = 0;
    for (const WallPiece &line : lines) {
        const int wall = wall_shown(map, line, pose, Eigen::Matrix3d::Zero(), scoring, decisions);
        if (wall >= 0) {
            sum +=
                std::min(compare(map[static_cast<size_t>(wall)], line, pose).common, line.end - line.start);
        }
    }
    return sum;
}

} // namespace reference
