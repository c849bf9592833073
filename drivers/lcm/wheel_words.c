#include "lcm/wheel_words.h"

#include "track/estimate.h"

const char *ale_wheel_fault_word(uint8_t wheel_fault)
{
    static const char *const words[] = {
        [ALE_WHEELS_FINE] = "fine",       [ALE_WHEELS_CONTRADICT] = "contradict",
        [ALE_WHEELS_STALLED] = "stalled", [ALE_WHEELS_REVERSED] = "reversed",
        [ALE_WHEELS_LATE] = "late",       [ALE_WHEELS_SCALE] = "scale",
    };
    return wheel_fault < sizeof words / sizeof words[0] ? words[wheel_fault] : "unknown";
}
