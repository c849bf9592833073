/* A first drive: what the wheels counted beside what the scans saw, and what is wrong with the counting, in
 * plain words.
 *
 *   FirstDrive drive;  ... drive.seen.push_back(..);  drive.counted.push_back(..);
 *   const Verdict verdict = judge(drive);
 *   if (verdict.missing.empty()) for (const Finding &f : verdict.findings) ...
 *
 * Nothing is believed of the counting beforehand: ways are compared by their lengths, turns by their sums,
 * directions with the sender's own headings; so each mistake shows by itself whatever else is wrong. */
#ifndef ALE_ROBOT_CALIBRATE_FIRST_DRIVE_H
#define ALE_ROBOT_CALIBRATE_FIRST_DRIVE_H

#include <string>
#include <vector>

namespace calibrate
{

/* A pose at an instant, seconds on one clock for both. */
struct TimedPose {
    double time;
    double x;
    double y;
    double theta;
};

struct FirstDrive {
    std::vector<TimedPose> seen;    /* by the scans; metres, radians; only where the robot knew its place */
    std::vector<TimedPose> counted; /* by the wheels, when it was heard; whatever was sent */
};

struct Finding {
    std::string subject; /* "way", "turns", "axes", "time" */
    bool fine;
    std::string words;
};

struct Verdict {
    std::string missing; /* what is still to be driven; empty: enough */
    std::vector<Finding> findings;
};

/* Poses in the order of time. O(n) but for the search of the lag: some hundred times that. */
Verdict judge(const FirstDrive &drive);

} // namespace calibrate

#endif
