/* Runs the estimate task over scans while the kernel allows its thread one system call, the wait of the
 * real-time port. Anything else ends the process by SIGSYS. Prints how many scans were answered.
 *
 * The process ends without an orderly stop: the thread could not make the calls that its end needs. */
#include <linux/futex.h>
#include <seccomp.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "firmware/room.hpp"

extern "C" {
#include "estimate/estimate.h"
}

namespace
{

constexpr int kScans = 400;
constexpr int64_t kPeriodUs = 100000;
constexpr double kStepM = 0.002;

void run_filtered(ale_rt_task_t *self, void *user)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
    const scmp_arg_cmp wait = SCMP_A1(SCMP_CMP_EQ, FUTEX_WAIT_BITSET_PRIVATE);
    if (!filter || seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(futex), 1, wait) < 0 ||
        seccomp_load(filter) < 0) {
        std::fputs("the system call filter is refused by this kernel\n", stderr);
        std::_Exit(3);
    }
    ale_estimator_run(self, user);
}

void wait_for_result(ale_exchange_t &exchange)
{
    while (ale_ring_ready(exchange.results) == 0) {
        usleep(100);
    }
    ale_ring_release(exchange.results);
}

void give_odometry(ale_exchange_t &exchange, int64_t stamp_us, double x)
{
    auto *sample = static_cast<ale_odometry_t *>(ale_ring_reserve(exchange.odometry));
    *sample = {};
    sample->stamp_us = stamp_us;
    sample->pose.x_um = static_cast<int32_t>(x * 1e6);
    ale_ring_commit(exchange.odometry);
}

/* The room walked through, with some scans lost and the map handed over every few. */
void give_scan(ale_exchange_t &exchange, int k)
{
    const int64_t stamp_us = kPeriodUs * (k + 1);
    const double x = kStepM * (k % (kScans / 2));
    give_odometry(exchange, stamp_us, x);
    auto *record = static_cast<ale_scan_record_t *>(ale_ring_reserve(exchange.scans));
    record->lost = k % 50 == 49;
    record->arrival_us = ale_clock_now_us(&exchange.clock);
    room::fill(record->scan, x, 0.1, stamp_us);
    ale_ring_commit(exchange.scans);
    ale_rt_release_post(exchange.arrived);
}

} // namespace

int main()
{
    static ale_exchange_t exchange;
    const ale_rt_config_t realtime = {0, -1, false};
    ale_rt_report_t report;
    ale_config_t config = ale_config_default();
    if (ale_rt_start(&realtime, &report) < 0 ||
        ale_exchange_open(&exchange, ale_clock_start(ALE_CLOCK_REAL)) < 0) {
        return 1;
    }
    ale_estimator_t *estimator = ale_estimator_create(&config, &exchange);
    const ale_rt_task_config_t task = {"filtered", ALE_RT_HARD, run_filtered, estimator, 0};
    if (!estimator || !ale_rt_task_start(&task)) {
        return 1;
    }
    for (int k = 0; k < kScans; k++) {
        give_scan(exchange, k);
        wait_for_result(exchange);
    }
    std::printf("%d\n", kScans);
    std::fflush(stdout);
    std::_Exit(0);
}
