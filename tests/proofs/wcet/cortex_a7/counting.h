/* How a program under qemu-arm tells the plugin cortex_a7 what is counted: by a number that no system call of
 * ARM has, which the kernel refuses. */
#ifndef WCET_COUNTING_H
#define WCET_COUNTING_H

enum {
    COUNTING_CALL = 0x7e57,
    COUNTING_TOGGLES = 0, /* begins to count, or stops */
    COUNTING_WRITES = 1   /* writes what was counted, and begins at zero, with empty caches */
};

#endif
