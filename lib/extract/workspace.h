/* Working memory of the extractor: the parts of its steps, put together. For extract.c, and for those who
 * embed an extractor or look into it. */
#ifndef ALE_EXTRACT_WORKSPACE_H
#define ALE_EXTRACT_WORKSPACE_H

#include <stdint.h>

#include "base/stage.h"
#include "extract/config.h"
#include "extract/lowess.h"
#include "extract/run_list.h"

struct ale_extractor {
    ale_run_list_t runs; /* with the prepared scan that they are runs of */
    ale_extract_config_t config;
    ale_stage_hook_t hook;
    uint16_t outliers;                 /* points set aside in this scan */
    int32_t smooth_q44[ALE_MAX_BEAMS]; /* 1 / range smoothed, where that is asked for */
    ale_lowess_work_t lowess;
};

#endif
