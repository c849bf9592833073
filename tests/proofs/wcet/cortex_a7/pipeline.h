/* How many cycles a row of instructions keeps a Cortex-A7 busy, its caches apart: the pipeline as ARM has
 * described it for gcc's scheduler (gcc/config/arm/cortex-a7.md). Where that leaves a choice the longer one
 * is taken: one instruction is issued in a cycle, never two; no branch but one to a fixed place is foreseen;
 * a division takes as long as of 32 bits it can; what a row has begun is waited for at its end. */
#ifndef WCET_PIPELINE_H
#define WCET_PIPELINE_H

#include <stdint.h>

enum { PIPELINE_REGISTERS = 16 };

typedef struct {
    uint32_t now;                       /* cycle in which the next instruction may be issued */
    uint32_t ready[PIPELINE_REGISTERS]; /* cycle in which a result may be computed with, */
    uint32_t
        settled[PIPELINE_REGISTERS]; /* or be shifted or an address, which is asked for a stage earlier */
} pipeline_t;

/* Takes in the next instruction of a row that began with a pipeline of zeros, as capstone writes it:
 * "ldr r3, [r4, #4]". */
void pipeline_issue(pipeline_t *pipeline, const char *instruction);

/* Cycles until all results are there. */
uint32_t pipeline_cycles(const pipeline_t *pipeline);

#endif
