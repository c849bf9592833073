/* The core's types as records, and scans of arrays. */
#ifndef ALE_PYTHON_CONVERT_H
#define ALE_PYTHON_CONVERT_H

#include "arguments.h"

extern "C" {
#include "track/pipeline.h"
}

namespace ale::binding
{

/* NaN is a beam that says nothing, +inf one that met nothing, -inf one that met something too near (ROS's
 * REP 117). */
void fill_scan(ale_scan_t &scan, const ale_binding_scan_t &asked);

void put_features(const ale_binding_features_t &out, const ale_features_t &features);
ale_estimate_record_t record_of(const ale_estimate_t &estimate);
ale_wall_record_t record_of(const ale_map_line_t &wall);
ale_map_corner_record_t record_of(const ale_map_corner_t &corner);

} // namespace ale::binding

#endif
