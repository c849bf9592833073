#include "graph/optimise/scan_node.h"

namespace ale
{

namespace
{

// Echoes to each side that give the normal of a point off the lines, and how far apart they may be.
struct Neighbourhood {
    size_t echoes;
    double gap_m;
};
constexpr Neighbourhood close{3, 0.12};
constexpr Neighbourhood coarse{1, 0.35}; // for sensors with few beams

struct Echo {
    Eigen::Vector2d p; // sensor's frame
    int beam;
};

struct Echoes {
    std::vector<Echo> echo;
    int reach; // beams from one to the next of the same surface, at most
};

Echoes echoes_of(const ale_scan_t &scan, const uint32_t *bearing_bam)
{
    Echoes echoes{{}, ale_scan_is_sparse(&scan) ? ALE_MAX_GAP_BEAMS : 1};
    for (int k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID && scan.range_um[k] > 0) {
            const uint32_t bearing = bearing_bam ? bearing_bam[k] : ale_scan_bearing(&scan, k);
            const double range = scan.range_um[k] * 1e-6;
            echoes.echo.push_back(
                {{range * ale_cos_q30(bearing) / one_q30, range * ale_sin_q30(bearing) / one_q30}, k});
        }
    }
    return echoes;
}

// The index of the line of each beam, or -1.
std::vector<int> lines_of(const ale_features_t &features, size_t beams)
{
    std::vector<int> line(beams, -1);
    for (int k = 0; k < features.line_count; k++) {
        const ale_line_t &one = features.line[k];
        const size_t last = one.last + (one.first > one.last ? beams : 0); // over the seam of a whole turn
        for (size_t beam = one.first; beam <= last && beam < 2 * beams; beam++) {
            line[beam % beams] = k;
        }
    }
    return line;
}

Eigen::Vector2d towards_sensor(const Eigen::Vector2d &normal, const Eigen::Vector2d &p)
{
    return normal.dot(p) > 0 ? Eigen::Vector2d(-normal) : normal;
}

// Normal of a point off the lines, from the chord of its neighbours; zero if the surface is not continuous.
Eigen::Vector2d neighbourhood_normal(const Echoes &echoes, size_t at, const Neighbourhood &around)
{
    const std::vector<Echo> &echo = echoes.echo;
    if (at < around.echoes || at + around.echoes >= echo.size()) {
        return {0, 0};
    }
    for (size_t k = at - around.echoes; k < at + around.echoes; k++) {
        if (echo[k + 1].beam - echo[k].beam > echoes.reach ||
            (echo[k + 1].p - echo[k].p).norm() > around.gap_m) {
            return {0, 0};
        }
    }
    const Eigen::Vector2d chord = echo[at + around.echoes].p - echo[at - around.echoes].p;
    return towards_sensor(Eigen::Vector2d(-chord.y(), chord.x()).normalized(), echo[at].p);
}

Guess guess_of(ale_claim_t claim)
{
    switch (claim) {
    case ALE_CLAIM_NONE:
    case ALE_CLAIM_REACHED:
        return Guess::anywhere;
    case ALE_CLAIM_DRIVEN:
        return Guess::led;
    case ALE_CLAIM_NEAR:
    case ALE_CLAIM_SAID:
        break;
    }
    return Guess::near;
}

// Foot of the point on the line: free of the beam's own noise.
Eigen::Vector2d on_line(const ale_line_t &line, const Eigen::Vector2d &p)
{
    const double alpha = to_radians(line.alpha_bam);
    const Eigen::Vector2d n(cosine(alpha), sine(alpha));
    return p - n * (n.dot(p) - line.rho_um * 1e-6);
}

Eigen::Vector2d line_normal(const ale_line_t &line, const Eigen::Vector2d &p)
{
    const double alpha = to_radians(line.alpha_bam);
    return towards_sensor({cosine(alpha), sine(alpha)}, p);
}

CornerFeature corner_of(const ale_corner_t &corner, const Pose &sensor)
{
    const double bisector = to_radians(corner.bisector_bam);
    return {apply(sensor, to_metres(corner.p)), wrapped(bisector + sensor.theta),
            corner.angle_bam / bam_per_radian, corner.kind == ALE_CORNER_CONVEX};
}

struct DeskewedScan {
    const ale_scan_t &scan;
    const uint32_t *bearing_bam; // NULL: the scan's own
    const ale_features_t &features;
    Pose sensor;
};

// Calls put(point, has_coarse_normal) for points at least node_point_spacing_m apart.
template <class Put> void each_point(const DeskewedScan &seen, const Put &put)
{
    const Eigen::Matrix2d turn = rotation(seen.sensor.theta);
    const Echoes echoes = echoes_of(seen.scan, seen.bearing_bam);
    const std::vector<int> line = lines_of(seen.features, seen.scan.beams);
    Eigen::Vector2d last(1e9, 1e9);
    for (size_t k = 0; k < echoes.echo.size(); k++) {
        const Echo &echo = echoes.echo[k];
        if ((echo.p - last).norm() < node_point_spacing_m) {
            continue;
        }
        last = echo.p;
        const int number = line[static_cast<size_t>(echo.beam)];
        const ale_line_t *on = number < 0 ? nullptr : &seen.features.line[number];
        const Eigen::Vector2d p = on ? on_line(*on, echo.p) : echo.p;
        Eigen::Vector2d normal = on ? line_normal(*on, echo.p) : neighbourhood_normal(echoes, k, close);
        const bool is_coarse = normal.isZero();
        if (is_coarse) {
            normal = neighbourhood_normal(echoes, k, coarse);
        }
        put(SurfacePoint{apply(seen.sensor, p), turn * normal}, is_coarse);
    }
}

} // namespace

Node node_of(const ale_keyframe_t &keyframe)
{
    const Pose sensor = from_core(keyframe.sensor);
    Node node{keyframe.scan,
              from_core(keyframe.smooth),
              from_core(keyframe.map),
              0,
              keyframe.broken,
              keyframe.weak,
              {},
              {},
              {},
              {},
              {sensor.x, sensor.y}};
    node.map_id = keyframe.map_id;
    node.guess = guess_of(keyframe.claim);
    node.stamp_us = keyframe.stamp_us;
    node.walls = walls_of(keyframe.features, sensor);
    each_point(
        {keyframe.taken, keyframe.straightened ? keyframe.bearing_bam : nullptr, keyframe.features, sensor},
        [&node](const SurfacePoint &point, bool is_coarse) {
            node.points.push_back(point);
            node.coarse_normal.push_back(is_coarse);
        });
    for (int k = 0; k < keyframe.features.corner_count; k++) {
        node.corners.push_back(corner_of(keyframe.features.corner[k], sensor));
    }
    return node;
}

std::vector<WallDirection> walls_of(const ale_features_t &features, const Pose &sensor)
{
    std::vector<WallDirection> walls;
    for (int k = 0; k < features.line_count; k++) {
        const ale_line_t &line = features.line[k];
        const double alpha = to_radians(line.alpha_bam);
        walls.push_back({wrapped(alpha + sensor.theta), length((line.end.x_um - line.start.x_um) * 1e-6,
                                                               (line.end.y_um - line.start.y_um) * 1e-6)});
    }
    return walls;
}

void add_later_walls(const Pose &smooth, const std::vector<WallDirection> &walls, Node *node)
{
    if (node->later_scans == most_later_scans) {
        return;
    }
    const double turned = smooth.theta - node->smooth.theta;
    for (const WallDirection &wall : walls) {
        node->later_walls.push_back({wrapped(wall.direction_rad + turned), wall.length_m});
    }
    node->later_scans++;
}

std::vector<SurfacePoint> surface_of(const ale_seen_t &seen, const ale_features_t &features)
{
    std::vector<SurfacePoint> points;
    const Pose sensor = from_core(ale_pose_between(seen.robot, seen.posed.sensor));
    each_point({*seen.posed.scan, seen.posed.bearing_bam, features, sensor},
               [&points](const SurfacePoint &point, bool) {
                   if (!point.normal.isZero()) {
                       points.push_back(point);
                   }
               });
    return points;
}

} // namespace ale
