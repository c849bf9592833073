/* The self-check of the machine: what of it decides whether deadlines can be kept. Asked once, before the
 * tasks run. */
#ifndef ALE_FIRMWARE_REALTIME_MACHINE_H
#define ALE_FIRMWARE_REALTIME_MACHINE_H

#include <stdint.h>

#include "realtime/findings.h"

/* `root` stands before /sys (tests; else ""). Each adds one finding.
 *
 * Kernel: PREEMPT_RT or not, and which. Timer: a resolution of a microsecond or better. Governor: the
 * processors' frequency stays up: "performance", or nothing that scales it; of processor `cpu`, or of all
 * when that is negative. */
void ale_rt_check_kernel(ale_rt_findings_t *findings, const char *root);
void ale_rt_check_timer(ale_rt_findings_t *findings);
void ale_rt_check_governor(ale_rt_findings_t *findings, int32_t cpu, const char *root);

#endif
