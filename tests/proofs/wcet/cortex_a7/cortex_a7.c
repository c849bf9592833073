/* A plugin of qemu-arm: the cycles that a Cortex-A7 would take for what the program has counted. The program
 * says when by a system call that there is none of (counting.h); the counts are written as callgrind writes
 * its own, to BASE.1, BASE.2 ... of the plugin's argument out=BASE. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "caches.h"
#include "counting.h"
#include "pipeline.h"
#include "qemu_plugin.h"

/* A row of instructions that are executed one after the other. */
typedef struct {
    uint32_t address;
    uint32_t bytes;
    uint32_t instructions;
    uint32_t cycles;
} row_t;

QEMU_PLUGIN_EXPORT int qemu_plugin_version = QEMU_PLUGIN_VERSION;

static const char *out = "cycles";
static uint32_t dumps;
static bool counting;
static uint64_t instructions;
static uint64_t cycles;

static void execute(unsigned int cpu, void *user)
{
    (void)cpu;
    const row_t *row = user;
    if (counting) {
        instructions += row->instructions;
        cycles += row->cycles + caches_fetch(row->address, row->bytes);
    }
}

static void access_memory(unsigned int cpu, qemu_plugin_meminfo_t info, uint64_t address, void *user)
{
    (void)cpu;
    (void)user;
    if (counting) {
        cycles += caches_access((uint32_t)address, UINT32_C(1) << qemu_plugin_mem_size_shift(info));
    }
}

static void take_in(row_t *row, pipeline_t *pipeline, struct qemu_plugin_insn *insn)
{
    char *text = qemu_plugin_insn_disas(insn);
    pipeline_issue(pipeline, text);
    free(text);
    row->bytes += (uint32_t)qemu_plugin_insn_size(insn);
    row->instructions++;
    qemu_plugin_register_vcpu_mem_cb(insn, access_memory, QEMU_PLUGIN_CB_NO_REGS, QEMU_PLUGIN_MEM_RW, NULL);
}

/* A row lives as long as qemu may execute it: to the end. */
static void translate(qemu_plugin_id_t id, struct qemu_plugin_tb *tb)
{
    (void)id;
    row_t *row = calloc(1, sizeof *row);
    if (!row) {
        abort();
    }
    pipeline_t pipeline = {0};
    row->address = (uint32_t)qemu_plugin_tb_vaddr(tb);
    for (size_t k = 0; k < qemu_plugin_tb_n_insns(tb); k++) {
        take_in(row, &pipeline, qemu_plugin_tb_get_insn(tb, k));
    }
    row->cycles = pipeline_cycles(&pipeline);
    qemu_plugin_register_vcpu_tb_exec_cb(tb, execute, QEMU_PLUGIN_CB_NO_REGS, row);
}

static void dump(void)
{
    char path[4096];
    snprintf(path, sizeof path, "%s.%" PRIu32, out, ++dumps);
    FILE *file = fopen(path, "w");
    if (!file || fprintf(file, "totals: %" PRIu64 " %" PRIu64 "\n", cycles, instructions) < 0 ||
        fclose(file) != 0) {
        perror(path);
        exit(1);
    }
    instructions = 0;
    cycles = 0;
    caches_empty();
}

static void called(qemu_plugin_id_t id, unsigned int cpu, int64_t number, uint64_t a1, uint64_t a2,
                   uint64_t a3, uint64_t a4, uint64_t a5, uint64_t a6, uint64_t a7, uint64_t a8)
{
    (void)id, (void)cpu, (void)a2, (void)a3, (void)a4, (void)a5, (void)a6, (void)a7, (void)a8;
    if (number != COUNTING_CALL) {
        return;
    }
    if (a1 == COUNTING_TOGGLES) {
        counting = !counting;
    } else {
        dump();
    }
}

QEMU_PLUGIN_EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc,
                                           char **argv);

int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc, char **argv)
{
    (void)info;
    for (int k = 0; k < argc; k++) {
        if (strncmp(argv[k], "out=", 4) != 0) {
            fprintf(stderr, "cortex_a7: unknown argument %s (out=BASE)\n", argv[k]);
            return 1;
        }
        out = argv[k] + 4;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
    qemu_plugin_register_vcpu_syscall_cb(id, called);
    return 0;
}
