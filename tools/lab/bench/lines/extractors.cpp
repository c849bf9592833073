#include "lab/bench/lines/extractors.hpp"

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "lab/bench/lines/score.hpp"
#include "lab/bench/lines/textbook/textbook.hpp"

extern "C" {
#include "extract/extract.h"
}

namespace bench
{
namespace
{

constexpr double radians_per_bam = 2 * pi / 4294967296.0;

Point metres(const ale_point_t &p)
{
    return {p.x_um * 1e-6, p.y_um * 1e-6};
}

struct Free {
    void operator()(ale_extractor_t *e) const
    {
        std::free(e);
    }
};

ale_extractor_t *shared_extractor()
{
    static const std::unique_ptr<ale_extractor_t, Free> extractor = [] {
        std::unique_ptr<ale_extractor_t, Free> e(
            static_cast<ale_extractor_t *>(std::calloc(1, ale_extractor_size())));
        const ale_extract_config_t config = ale_extract_default_config();
        if (!e || ale_extractor_init(e.get(), &config) < 0) {
            throw std::runtime_error("the extractor does not take its own default configuration");
        }
        return e;
    }();
    return extractor.get();
}

Extraction ale(const ale_scan_t &scan)
{
    static const auto features = std::make_unique<ale_features_t>();
    ale_extract_scan(shared_extractor(), &scan, nullptr, features.get());
    Extraction out;
    for (int k = 0; k < features->line_count; k++) {
        const ale_line_t &l = features->line[k];
        out.lines.push_back({l.first,
                             l.last,
                             {wrapped(l.alpha_bam * radians_per_bam), l.rho_um * 1e-6},
                             metres(l.start),
                             metres(l.end),
                             1e-9 * std::sqrt(static_cast<double>(l.var_alpha_nrad2))});
    }
    for (int k = 0; k < features->corner_count; k++) {
        out.corners.push_back(metres(features->corner[k].p));
    }
    return out;
}

using Method = std::vector<Line> (*)(const ale_scan_t &, const textbook::Setting &);

struct Textbook {
    const char *name;
    const char *title;
    const char *function;
    Method method;
    Threshold tuned;
    Threshold fixed;
    const char *fixed_name;
};

const std::vector<Textbook> textbook_methods{
    {"split-merge",
     "split and merge",
     "split_and_merge",
     textbook::split_and_merge,
     {0.03, 0.025},
     {0.03, 0},
     "30mm"},
    {"incremental", "incremental", "incremental", textbook::incremental, {0.03, 0.025}, {0.03, 0}, "30mm"},
    {"ransac", "RANSAC", "ransac", textbook::ransac, {0.008, 0.012}, {0.03, 0}, "30mm"},
    {"hough", "Hough", "hough", textbook::hough, {0.015, 0.015}, {0.03, 0}, "30mm"},
    {"regression",
     "line regression",
     "line_regression",
     textbook::line_regression,
     {0.03, 0.03},
     {0.03, 0},
     "30mm"},
    {"static-ale",
     "ALE, static threshold",
     "static_ale",
     textbook::static_ale,
     {0.005, 0.008},
     {0.0037, 0},
     "3.7mm"},
};

Extractor from_textbook(const Textbook &entry, const std::string &variant, const Threshold &threshold)
{
    textbook::Setting setting;
    setting.threshold = threshold.floor;
    setting.proportional = threshold.proportional;
    const auto extract = [method = entry.method, setting](const ale_scan_t &scan) {
        Extraction out;
        out.lines = method(scan, setting);
        out.corners = derived_corners(out.lines);
        return out;
    };
    return {entry.name + std::string("-") + variant, entry.title + std::string(", ") + variant,
            std::string("bench::textbook::") + entry.function + "*", extract};
}

} // namespace

std::vector<Extractor> extractors(const std::optional<Threshold> &replaced)
{
    std::vector<Extractor> all{{"ale", "ALE (libale)", "ale_extract_scan", ale}};
    for (const Textbook &entry : textbook_methods) {
        all.push_back(from_textbook(entry, "tuned", replaced.value_or(entry.tuned)));
        all.push_back(from_textbook(entry, entry.fixed_name, entry.fixed));
    }
    return all;
}

} // namespace bench
