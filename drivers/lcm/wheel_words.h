/* What wheels do that scans contradict, in a word: the same in messages, in files and for people. */
#ifndef ALE_LCM_WHEEL_WORDS_H
#define ALE_LCM_WHEEL_WORDS_H

#include <stdint.h>

/* wheel_fault: ale_wheel_fault_t. "fine", "contradict", "stalled", "reversed", "late", "scale"; "unknown" for
 * any other number. A constant text. */
const char *ale_wheel_fault_word(uint8_t wheel_fault);

#endif
