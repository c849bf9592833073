// The chain of the twins of lib/extract: from the valid beams of a scan to its lines and corners.
#ifndef ALE_TESTS_REFERENCE_EXTRACTION_H
#define ALE_TESTS_REFERENCE_EXTRACTION_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

struct ExtractedLine {
    int first; // beams
    int last;
    double alpha;
    double rho; // mm
    Run run;    // points
};

struct Extraction {
    std::vector<ExtractedLine> lines;
    std::vector<Run> curves;  // beams
    std::vector<int> corners; // index of the first line of each
    NoiseOfScan noise;
    Decisions decisions;
};

struct ExtractionSettings {
    NoiseOfScan prior;
    int least_points; // of a line
    double least_length;
    double first_bearing; // radians, of beam 0
    double step;          // from beam to beam
};

Extraction extract(const ScanPoints &valid, const ExtractionSettings &settings);

} // namespace reference

#endif
