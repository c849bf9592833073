#include "lab/replay/features_file.h"

extern "C" {
#include "base/trig.h"
}

namespace ale
{

namespace
{

const char *const end_names[] = {"edge", "occluded", "limit"};
const char *const corner_names[] = {"convex", "concave"};
const char *const refusal_names[ALE_REFUSALS] = {"few_points", "short",  "vague",
                                                 "rough",      "curved", "capacity"};

/* A line's variances are in nrad^2, um nrad and um^2, a point's all in um^2. */
constexpr int nrad2 = -18;
constexpr int um_nrad = -15;
constexpr int um2 = -12;

} // namespace

void FeaturesFile::put_point(const ale_point_t &p, const char *x_name, const char *y_name)
{
    file_.put("\"").put(x_name).put("\":").put_decimal(p.x_um, 6);
    file_.put(",\"").put(y_name).put("\":").put_decimal(p.y_um, 6).put(",");
}

void FeaturesFile::put_covariance(int64_t first, int64_t mixed, int64_t second, int first_exponent,
                                  int mixed_exponent)
{
    file_.put("\"cov\":[").put_scaled(first, first_exponent).put(",");
    file_.put_scaled(mixed, mixed_exponent).put(",").put_scaled(second, um2).put("],");
}

void FeaturesFile::put_line(const ale_line_t &line)
{
    file_.put("{\"first\":").put_integer(line.first).put(",\"last\":").put_integer(line.last).put(",");
    put_point(line.start, "x1", "y1");
    put_point(line.end, "x2", "y2");
    file_.put("\"alpha\":").put_angle(line.alpha_bam).put(",\"rho\":").put_decimal(line.rho_um, 6).put(",");
    put_covariance(line.var_alpha_nrad2, line.cov_alpha_rho, line.var_rho_um2, nrad2, um_nrad);
    file_.put("\"rmse\":").put_decimal(line.rmse_um, 6).put(",\"points\":").put_integer(line.points);
    file_.put(",\"first_end\":\"").put(end_names[line.first_end]).put("\",\"last_end\":\"");
    file_.put(end_names[line.last_end]).put("\"}");
}

void FeaturesFile::put_corner(const ale_corner_t &corner)
{
    file_.put("{");
    put_point(corner.p, "x", "y");
    file_.put("\"angle\":")
        .put_decimal(ale_bam_to_nrad(static_cast<int32_t>(corner.angle_bam / 2)) * 2, 9)
        .put(",");
    put_covariance(corner.cov_um2[0], corner.cov_um2[1], corner.cov_um2[2], um2, um2);
    file_.put("\"kind\":\"")
        .put(corner_names[corner.kind])
        .put("\",\"first_line\":")
        .put_integer(corner.first_line);
    file_.put(",\"second_line\":").put_integer(corner.second_line).put("}");
}

void FeaturesFile::put_curve(const ale_curve_t &curve)
{
    file_.put("{\"first\":").put_integer(curve.first).put(",\"last\":").put_integer(curve.last).put(",");
    put_point(curve.centre, "x", "y");
    file_.put("\"radius\":").put_decimal(curve.radius_um, 6).put("}");
}

void FeaturesFile::put_refused(const ale_features_t &features)
{
    file_.put("{");
    for (int i = 0; i < ALE_REFUSALS; i++) {
        file_.put(i ? ",\"" : "\"").put(refusal_names[i]).put("\":").put_integer(features.refused[i]);
    }
    file_.put("}");
}

void FeaturesFile::put(uint32_t scan, int64_t stamp_us, const ale_features_t *features)
{
    static const ale_features_t nothing{};
    const ale_features_t &f = features ? *features : nothing;
    file_.put("{\"scan\":").put_integer(scan).put(",\"t\":").put_decimal(stamp_us, 6);
    file_.put(features ? ",\"lines\":[" : ",\"lost\":true,\"lines\":[");
    for (int i = 0; i < f.line_count; i++) {
        file_.put(i ? "," : "");
        put_line(f.line[i]);
    }
    file_.put("],\"corners\":[");
    for (int i = 0; i < f.corner_count; i++) {
        file_.put(i ? "," : "");
        put_corner(f.corner[i]);
    }
    file_.put("],\"curves\":[");
    for (int i = 0; i < f.curve_count; i++) {
        file_.put(i ? "," : "");
        put_curve(f.curve[i]);
    }
    file_.put("],\"outliers\":").put_integer(f.outliers).put(",\"refused\":");
    put_refused(f);
    file_.put("}\n");
}

} // namespace ale
