/* The caches of a Cortex-A7 (Technical Reference Manual, DDI 0464F): 32 KiB for instructions, 2 ways of lines
 * of 32 bytes; 32 KiB for data, 4 ways of 64 bytes; 512 KiB for both, 8 ways. Of those of a set the line goes
 * that was not asked for longest. Nothing is fetched ahead, and a write waits for its line as a read does. */
#ifndef WCET_CACHES_H
#define WCET_CACHES_H

#include <stdint.h>

/* What is asked for next is in none of them. */
void caches_empty(void);

/* Cycles that are lost for bytes of code or of data that are not at hand. */
uint32_t caches_fetch(uint32_t address, uint32_t bytes);
uint32_t caches_access(uint32_t address, uint32_t bytes);

#endif
