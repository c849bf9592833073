#include "binding.h"

#include <cstddef>
#include <sstream>
#include <string>

#include "settings.h"

extern "C" {
#include "base/limits.h"
#include "base/version.h"
#include "map/line_map.h"
}

namespace ale::binding
{

namespace
{

struct Field {
    const char *name;
    const char *format; /* NumPy's, or that of an element */
    size_t offset;
    size_t size;
};

struct Record {
    const char *name;
    size_t size;
    std::initializer_list<Field> fields;
};

#define FIELD(record, member, format)                                                                        \
    {                                                                                                        \
#member, format, offsetof(record, member), sizeof(record::member)                                    \
    }

void put_fields(std::ostream &out, const Record &record)
{
    const char *comma = "";
    for (const Field &field : record.fields) {
        out << comma << "[\"" << field.name << "\",\"" << field.format << "\"," << field.offset << ","
            << field.size << "]";
        comma = ",";
    }
}

#define S(member, format) FIELD(ale_scanner_record_t, member, format)
#define L(member, format) FIELD(ale_line_record_t, member, format)
#define C(member, format) FIELD(ale_corner_record_t, member, format)
#define U(member, format) FIELD(ale_curve_record_t, member, format)
#define E(member, format) FIELD(ale_estimate_record_t, member, format)
#define P(member, format) FIELD(ale_pose_record_t, member, format)
#define W(member, format) FIELD(ale_wall_record_t, member, format)
#define M(member, format) FIELD(ale_map_corner_record_t, member, format)

const Record records[] = {
    {"scanner",
     sizeof(ale_scanner_record_t),
     {S(first_bearing, "f8"), S(step, "f8"), S(range_min, "f8"), S(range_max, "f8"), S(beam_time, "f8"),
      S(stamp_beam, "i4")}},
    {"line",
     sizeof(ale_line_record_t),
     {L(x1, "f8"), L(y1, "f8"), L(x2, "f8"), L(y2, "f8"), L(alpha, "f8"), L(rho, "f8"), L(cov, "f8"),
      L(rmse, "f8"), L(var_start, "f8"), L(var_end, "f8"), L(first, "u2"), L(last, "u2"), L(points, "u2"),
      L(first_end, "u1"), L(last_end, "u1")}},
    {"corner",
     sizeof(ale_corner_record_t),
     {C(x, "f8"), C(y, "f8"), C(cov, "f8"), C(angle, "f8"), C(bisector, "f8"), C(first_line, "u2"),
      C(second_line, "u2"), C(kind, "u1")}},
    {"curve",
     sizeof(ale_curve_record_t),
     {U(x, "f8"), U(y, "f8"), U(radius, "f8"), U(first, "u2"), U(last, "u2")}},
    {"estimate",
     sizeof(ale_estimate_record_t),
     {E(t, "f8"),
      E(x, "f8"),
      E(y, "f8"),
      E(theta, "f8"),
      E(map_x, "f8"),
      E(map_y, "f8"),
      E(map_theta, "f8"),
      E(cov, "f8"),
      E(information, "f8"),
      E(velocity, "f8"),
      E(cpu_s, "f8"),
      E(scan, "u4"),
      E(map_id, "u4"),
      E(lag_us, "i4"),
      E(matched_lines, "u2"),
      E(matched_corners, "u2"),
      E(state, "u1"),
      E(predicted, "?"),
      E(maps, "u1"),
      E(wheel_fault, "u1")}},
    {"pose",
     sizeof(ale_pose_record_t),
     {P(t, "f8"), P(x, "f8"), P(y, "f8"), P(theta, "f8"), P(measured, "?")}},
    {"wall",
     sizeof(ale_wall_record_t),
     {W(x1, "f8"), W(y1, "f8"), W(x2, "f8"), W(y2, "f8"), W(cov, "f8"), W(id, "u4"), W(seen, "u4"),
      W(map_id, "u4")}},
    {"map_corner",
     sizeof(ale_map_corner_record_t),
     {M(x, "f8"), M(y, "f8"), M(cov, "f8"), M(angle, "f8"), M(bisector, "f8"), M(seen, "u4"), M(kind, "u1")}},
};

std::string description()
{
    const ale_pipeline_config_t defaults = ale_pipeline_default_config();
    std::ostringstream out;
    out.precision(17);
    out << "{\"version\":\"" << ALE_VERSION << "\",\"max_beams\":" << ALE_MAX_BEAMS
        << ",\"max_range\":" << ALE_MAX_RANGE_UM / 1000000 << ",\"max_lines\":" << ALE_MAX_LINES
        << ",\"max_corners\":" << ALE_MAX_CORNERS << ",\"max_curves\":" << ALE_MAX_CURVES
        << ",\"max_blind\":" << ALE_MAX_BLIND_SECTORS << ",\"refusals\":" << ALE_REFUSALS
        << ",\"max_walls\":" << ALE_MAP_MAX_LINES << ",\"max_map_corners\":" << ALE_MAP_MAX_CORNERS
        << ",\"records\":{";
    const char *comma = "";
    for (const Record &record : records) {
        out << comma << "\"" << record.name << "\":{\"size\":" << record.size << ",\"fields\":[";
        put_fields(out, record);
        out << "]}";
        comma = ",";
    }
    out << "},\"settings\":[";
    comma = "";
    for (size_t i = 0; i < setting_count; i++) {
        const Setting &setting = settings[i];
        out << comma << "[\"" << setting.name << "\"," << setting.get(defaults) << "," << setting.least << ","
            << setting.most << "]";
        comma = ",";
    }
    out << "]}";
    return out.str();
}

} // namespace

} // namespace ale::binding

const char *ale_binding_describe(void)
{
    static const std::string text = ale::binding::description();
    return text.c_str();
}
