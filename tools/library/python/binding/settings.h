/* Settings by the names that ale-slamd's configuration gives them, as numbers in its units. */
#ifndef ALE_PYTHON_SETTINGS_H
#define ALE_PYTHON_SETTINGS_H

#include <cstddef>

#include "arguments.h"

extern "C" {
#include "track/pipeline.h"
}

namespace ale::binding
{

struct Setting {
    const char *name; /* section.key */
    double least;
    double most;
    double (*get)(const ale_pipeline_config_t &config);
    void (*set)(ale_pipeline_config_t &config, double value);
};

extern const Setting settings[];
extern const size_t setting_count;

/* The configuration that Python asks for. Values are within their ranges (ale/_checks.py). */
ale_pipeline_config_t config_of(const ale_binding_config_t &asked);

} // namespace ale::binding

#endif
