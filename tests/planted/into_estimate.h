/* Puts a call of ale_planted() into the estimate task. Before estimate.c, by -include. */
#include "exchange/ring.h"

#define ale_ring_ready(ring) (ale_planted(), ale_ring_ready(ring))
