/* What a scanner says of itself (VV, PP), and one turn of its measurements. */
#ifndef ALE_LAB_SIM_SCANNER_H
#define ALE_LAB_SIM_SCANNER_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/sim/geometry.h"

namespace sim
{

/* How the scans of a recording lie in bearing and time. SCIP has no word for it: PP says it in a line of its
 * own. */
struct Recorded {
    int64_t longest_gap_us = 0; /* between two scans */
    int32_t stamp_step = 0;     /* that the stamps belong to */
    int32_t step_ns = 0;        /* from step to step; 0: a scan was taken at once */
    int32_t origin_bam = 0;     /* bearing of step 0 */
    int32_t step_bam = 0;
    int32_t blind_before = 0; /* steps before this one, and from the other on, look at the robot itself */
    int32_t blind_from = 0;
};

/* The values of a real URG-04LX, firmware 3.1.04. Steps count counter-clockwise from the right rear. */
struct Scanner {
    std::string model = "URG-04LX(Hokuyo Automatic Co.,Ltd.)";
    std::string product = "SOKUIKI Sensor URG-04LX";
    std::string firmware = "3.1.04(02/Aug./2007)";
    std::string serial = "H0706400";
    int32_t min_mm = 20;       /* DMIN */
    int32_t max_mm = 5600;     /* DMAX */
    int32_t turn_steps = 1024; /* ARES: steps of a whole turn */
    int32_t first_step = 44;   /* AMIN */
    int32_t last_step = 725;   /* AMAX */
    int32_t front_step = 384;  /* AFRT */
    int32_t end_step = 768;    /* the last step that may be asked for */
    int32_t rpm = 600;         /* SCAN */
    bool tells_state = false;  /* knows %ST */
    std::optional<Recorded> recorded;

    int64_t period_us() const
    {
        return 60000000 / rpm;
    }
    double bearing(int32_t step) const
    {
        return (step - front_step) * 2 * pi / turn_steps;
    }
    /* When a step is measured, microseconds after step 0. */
    int64_t step_time_us(int32_t step) const
    {
        return period_us() * step / turn_steps;
    }
};

/* Code of a step that is outside the field of view. */
constexpr int32_t not_a_step = 19;

/* One turn. Times are microseconds of play: 0 is the first turn that is measured. */
struct Turn {
    uint32_t number = 0;
    int64_t start_us = 0;          /* passage of step 0: the device's stamp */
    int64_t recorded_us = 0;       /* stamp of a recording: the scanner's clock may have been set back */
    std::vector<int32_t> value_mm; /* of steps 0..end_step, error codes included */
};

} // namespace sim

#endif
