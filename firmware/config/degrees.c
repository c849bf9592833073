#include "config/degrees.h"

#include "base/fixed.h"

#define TURN_NDEG 360000000000

enum { NANO = 9 };

int ale_degrees_parse(const char *text, uint32_t *bam)
{
    int64_t ndeg = 0;
    if (ale_decimal_parse(text, NANO, &ndeg) < 0 || ale_abs64(ndeg) > TURN_NDEG) {
        return -1;
    }
    *bam = (uint32_t)ale_mul_div(ndeg, (int64_t)1 << 32, TURN_NDEG);
    return 0;
}

void ale_degrees_print(uint32_t bam, char text[ALE_DECIMAL_TEXT])
{
    const int64_t ndeg = ale_mul_div((int32_t)bam, TURN_NDEG, (int64_t)1 << 32);
    for (unsigned kept = 0; kept <= NANO; kept++) {
        uint32_t again = 0;
        ale_decimal_print(ale_decimal_round(ndeg, NANO, kept), NANO, text);
        if (ale_degrees_parse(text, &again) == 0 && again == bam) {
            return;
        }
    }
}
