#include "lab/merge/scan_places.h"

#include <cinttypes>
#include <cmath>
#include <stdexcept>

#include "common/export/formatted.h"

extern "C" {
#include "file/text.h"
}

namespace merge
{

namespace
{

using ale::Pose;

constexpr char head[] = "ALE-SLAM places 1";

[[noreturn]] void refuse()
{
    throw std::runtime_error("damaged");
}

ale_span_t word_of(ale_span_t *line)
{
    ale_span_t word;
    if (!ale_text_word(line, &word)) {
        refuse();
    }
    return word;
}

int64_t number_of(ale_span_t *line, int64_t low, int64_t high)
{
    int64_t number = 0;
    if (!ale_text_decimal(word_of(line), 0, &number) || number < low || number > high) {
        refuse();
    }
    return number;
}

ScanPlace place_of(ale_span_t line)
{
    ScanPlace place{};
    place.frame = static_cast<uint32_t>(number_of(&line, 0, UINT32_MAX));
    place.pose.x_um = static_cast<int32_t>(number_of(&line, INT32_MIN, INT32_MAX));
    place.pose.y_um = static_cast<int32_t>(number_of(&line, INT32_MIN, INT32_MAX));
    place.pose.theta_bam = static_cast<uint32_t>(number_of(&line, 0, UINT32_MAX));
    return place;
}

/* Pairs of poses, and the sums that a rigid shift from the one to the other is fitted by. */
struct Fit {
    size_t count = 0;
    Eigen::Vector2d from{0, 0};
    Eigen::Vector2d to{0, 0};
    double turn_cos = 0;
    double turn_sin = 0;

    void add(const Pose &a, const Pose &b)
    {
        count++;
        from += Eigen::Vector2d(a.x, a.y);
        to += Eigen::Vector2d(b.x, b.y);
        turn_cos += std::cos(b.theta - a.theta);
        turn_sin += std::sin(b.theta - a.theta);
    }
    /* Of headings: there are many, and each is known as well as what they see. */
    Pose shift() const
    {
        const double theta = std::atan2(turn_sin, turn_cos);
        const double n = static_cast<double>(count);
        const Eigen::Vector2d moved = to / n - ale::rotation(theta) * (from / n);
        return {moved.x(), moved.y(), theta};
    }
};

} // namespace

ScanPlaces places_of(const std::vector<Drive> &drives, size_t first)
{
    ScanPlaces places;
    std::map<uint32_t, uint32_t> frames{{0, 0}};
    for (size_t k = first; k < drives.size(); k++) {
        std::vector<ScanPlace> &of_drive = places[drives[k].checksum];
        for (const DriveScan &scan : drives[k].scans) {
            const auto next = static_cast<uint32_t>(frames.size());
            of_drive.push_back({ale::to_core(scan.pose), frames.emplace(scan.frame, next).first->second});
        }
    }
    return places;
}

std::string text_of(const ScanPlaces &places)
{
    std::string text = std::string(head) + "\n";
    for (const auto &[checksum, scans] : places) {
        text += ale::formatted("drive %" PRIu32 " %zu\n", checksum, scans.size());
        for (const ScanPlace &scan : scans) {
            text += ale::formatted("%" PRIu32 " %" PRId32 " %" PRId32 " %" PRIu32 "\n", scan.frame,
                                   scan.pose.x_um, scan.pose.y_um, scan.pose.theta_bam);
        }
    }
    return text;
}

ScanPlaces places_from(const std::string &text)
{
    ale_text_t lines = ale_text(text.data(), text.size());
    ale_span_t line;
    if (!ale_text_line(&lines, &line) || !ale_text_is(line, head)) {
        refuse();
    }
    ScanPlaces places;
    while (ale_text_line(&lines, &line)) {
        if (!ale_text_is(word_of(&line), "drive")) {
            refuse();
        }
        std::vector<ScanPlace> &scans = places[static_cast<uint32_t>(number_of(&line, 0, UINT32_MAX))];
        for (int64_t left = number_of(&line, 0, UINT32_MAX); left > 0; left--) {
            if (!ale_text_line(&lines, &line)) {
                refuse();
            }
            scans.push_back(place_of(line));
        }
    }
    return places;
}

void hold_frame(const ScanPlaces &before, std::vector<Drive> *drives)
{
    Fit fit;
    for (const Drive &drive : *drives) {
        const auto known = before.find(drive.checksum);
        for (size_t k = 0; known != before.end() && k < drive.scans.size(); k++) {
            const ScanPlace &was = known->second[k];
            if (was.frame == 0 && drive.scans[k].frame == 0) {
                fit.add(drive.scans[k].pose, ale::from_core(was.pose));
            }
        }
    }
    if (fit.count == 0) {
        return;
    }
    const Pose shift = fit.shift();
    for (Drive &drive : *drives) {
        for (DriveScan &scan : drive.scans) {
            scan.pose = scan.frame == 0 ? compose(shift, scan.pose) : scan.pose;
        }
    }
}

} // namespace merge
