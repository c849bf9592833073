// Scans of worlds made of walls, for the tests of extraction: ray casting in double, seeded noise.
#ifndef ALE_TESTS_LIB_EXTRACT_SCENE_H
#define ALE_TESTS_LIB_EXTRACT_SCENE_H

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

extern "C" {
#include "extract/extract.h"
#include "extract/workspace.h"
}

namespace scene
{

constexpr double pi = 3.14159265358979323846;
constexpr double urg_step = 2 * pi / 1024;

struct wall {
    double x1, y1, x2, y2;
};

inline double cast(const std::vector<wall> &walls, double bearing)
{
    const double c = std::cos(bearing);
    const double s = std::sin(bearing);
    double nearest = 0;
    for (const wall &w : walls) {
        const double dx = w.x2 - w.x1;
        const double dy = w.y2 - w.y1;
        const double det = dx * s - dy * c;
        if (std::fabs(det) < 1e-12) {
            continue;
        }
        const double r = (dx * w.y1 - dy * w.x1) / det;
        const double u = (c * w.y1 - s * w.x1) / det;
        if (r > 0 && u >= 0 && u <= 1 && (nearest == 0 || r < nearest)) {
            nearest = r;
        }
    }
    return nearest;
}

using scan_ptr = std::unique_ptr<ale_scan_t, decltype(&std::free)>;

inline scan_ptr empty_scan(int beams = 682, double first = -340 * urg_step, double step = urg_step)
{
    scan_ptr scan(static_cast<ale_scan_t *>(std::calloc(1, sizeof(ale_scan_t))), &std::free);
    scan->beams = static_cast<uint16_t>(beams);
    scan->first_bearing_bam =
        static_cast<uint32_t>(static_cast<int64_t>(std::llround(first / (2 * pi) * 4294967296.0)));
    scan->step_bam = static_cast<int32_t>(std::llround(step / (2 * pi) * 4294967296.0));
    scan->range_min_um = 20000;
    scan->range_max_um = ALE_MAX_RANGE_UM;
    for (int k = 0; k < beams; k++) {
        scan->flag[k] = ALE_BEAM_NO_RETURN;
    }
    return scan;
}

// The ranges of the beams from first to before end: millimetres by beam.
template <class RangeMm> void set_ranges(ale_scan_t *scan, int first, int end, const RangeMm &range_mm)
{
    for (int k = first; k < end; k++) {
        ale_scan_set_range(scan, static_cast<uint16_t>(k), static_cast<int32_t>(1000 * range_mm(k)));
    }
}

inline double bearing_of(const ale_scan_t &scan, int beam)
{
    return ale_scan_bearing(&scan, beam) * (2 * pi / 4294967296.0);
}

// sigma_mm: own noise of every range; quantum_mm: resolution of the sensor.
inline void see(ale_scan_t &scan, const std::vector<wall> &walls, double sigma_mm, unsigned seed,
                double quantum_mm = 1)
{
    std::mt19937 engine(seed);
    std::normal_distribution<double> gauss(0, sigma_mm);
    for (int k = 0; k < scan.beams; k++) {
        const double range = cast(walls, bearing_of(scan, k));
        if (range > 0.02) {
            const double mm =
                std::round((range * 1000 + (sigma_mm > 0 ? gauss(engine) : 0)) / quantum_mm) * quantum_mm;
            ale_scan_set_range(&scan, static_cast<uint16_t>(k), static_cast<int32_t>(std::lround(mm * 1000)));
        }
    }
}

inline std::vector<wall> box(double x1, double y1, double x2, double y2)
{
    return {{x1, y1, x2, y1}, {x2, y1, x2, y2}, {x2, y2, x1, y2}, {x1, y2, x1, y1}};
}

class extractor
{
  public:
    extractor() : extractor(ale_extract_default_config())
    {
    }

    explicit extractor(const ale_extract_config_t &config)
        : memory(static_cast<ale_extractor_t *>(std::calloc(1, ale_extractor_size()))),
          features(static_cast<ale_features_t *>(std::calloc(1, sizeof(ale_features_t))))
    {
        if (ale_extractor_init(memory.get(), &config) != 0) {
            std::abort();
        }
    }

    const ale_features_t &operator()(const ale_scan_t &scan, const uint32_t *bearing_bam = nullptr)
    {
        ale_extract_scan(memory.get(), &scan, bearing_bam, features.get());
        return *features;
    }

    ale_extractor_t *get()
    {
        return memory.get();
    }

  private:
    struct release {
        void operator()(void *p) const
        {
            std::free(p);
        }
    };
    std::unique_ptr<ale_extractor_t, release> memory;
    std::unique_ptr<ale_features_t, release> features;
};

} // namespace scene

#endif
