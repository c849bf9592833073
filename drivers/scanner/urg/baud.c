#include "scanner/urg/baud.h"

enum { BITS_PER_BYTE = 10, MOST_SKIP = 9, MARGIN_PERCENT = 95 };

static const int32_t rates[ALE_BAUD_RATES] = {ALE_BAUD_USUAL, ALE_BAUD_FACTORY, 57600, 500000,
                                              250000,         750000,           38400, 9600};

bool ale_baud_is_known(int32_t baud)
{
    for (uint32_t k = 0; k < ALE_BAUD_RATES; k++) {
        if (rates[k] == baud) {
            return true;
        }
    }
    return false;
}

int32_t ale_baud_candidate(int32_t preferred, uint32_t attempt)
{
    const int32_t first = preferred > 0 ? preferred : ALE_BAUD_USUAL;
    if (attempt == 0) {
        return first;
    }
    uint32_t rank = 0;
    for (uint32_t k = 0; k < ALE_BAUD_RATES; k++) {
        if (rates[k] != first && ++rank == attempt) {
            return rates[k];
        }
    }
    return first;
}

int64_t ale_baud_time_us(int32_t baud, uint32_t bytes)
{
    return baud > 0 ? (int64_t)bytes * BITS_PER_BYTE * 1000000 / baud : 0;
}

static bool fits(const ale_scip_request_t *request, int32_t baud, int32_t period_us)
{
    const int64_t budget_us = (int64_t)period_us * (request->skip + 1) * MARGIN_PERCENT / 100;
    return ale_baud_time_us(baud, ale_scip_request_frame_bytes(request)) <= budget_us;
}

void ale_baud_fit(ale_scip_request_t *request, int32_t baud, int32_t period_us)
{
    const ale_scip_request_t wish = *request;
    for (int32_t skip = wish.skip; skip <= MOST_SKIP; skip++) {
        for (uint8_t cluster = 1; cluster <= 2; cluster++) {
            for (uint8_t characters = wish.characters; characters >= 2; characters--) {
                request->skip = (uint8_t)skip;
                request->cluster = wish.cluster > cluster ? wish.cluster : cluster;
                request->characters = characters;
                if (fits(request, baud, period_us)) {
                    return;
                }
            }
        }
    }
}
