#include "pipeline.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum {
    WORD = 32,            /* longest name of an instruction or a register */
    STAGES = 8,           /* what a branch that was not foreseen costs anew */
    DIVISION_CYCLES = 20, /* two bits a cycle, and what is before and after it; gcc takes 5 for an estimate */
    PC = 15
};

typedef enum { ALU, MULTIPLY, DIVIDE, LOAD, STORE, FLOAT, BRANCH, FIXED_BRANCH } kind_t;

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* b, beq, bl, blx, bx, cbz, tbb; not bic, bfi, bfc. */
static bool is_branch(const char *name)
{
    return (name[0] == 'b' && !begins(name, "bic") && !begins(name, "bf") && !begins(name, "bkpt")) ||
           begins(name, "cb") || begins(name, "tb");
}

static kind_t branch_kind(const char *name, const char *operands)
{
    const bool always = strcmp(name, "b") == 0 || strcmp(name, "b.w") == 0 || strcmp(name, "bl") == 0 ||
                        strcmp(name, "blx") == 0;
    return always && operands[0] == '#' ? FIXED_BRANCH : BRANCH;
}

static kind_t kind_of(const char *name, const char *operands)
{
    static const struct {
        const char *name;
        kind_t kind;
    } kinds[] = {{"ldr", LOAD},      {"ldm", LOAD},      {"pop", LOAD},      {"str", STORE},
                 {"stm", STORE},     {"push", STORE},    {"mul", MULTIPLY},  {"mla", MULTIPLY},
                 {"mls", MULTIPLY},  {"umul", MULTIPLY}, {"umla", MULTIPLY}, {"umaal", MULTIPLY},
                 {"smul", MULTIPLY}, {"smla", MULTIPLY}, {"smml", MULTIPLY}, {"smmu", MULTIPLY},
                 {"sdiv", DIVIDE},   {"udiv", DIVIDE},   {"v", FLOAT}};
    if (is_branch(name)) {
        return branch_kind(name, operands);
    }
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (begins(name, kinds[k].name)) {
            return kinds[k].kind;
        }
    }
    return ALU;
}

/* Number of a core register, or -1. */
static int32_t register_of(const char *word)
{
    static const char *const names[] = {"sb", "sl", "fp", "ip", "sp", "lr", "pc"};
    for (int32_t k = 0; k < 7; k++) {
        if (strcmp(word, names[k]) == 0) {
            return 9 + k;
        }
    }
    if (word[0] != 'r' || !isdigit((unsigned char)word[1])) {
        return -1;
    }
    const int32_t number = word[2] == '\0' ? word[1] - '0' : 10 * (word[1] - '0') + word[2] - '0';
    return number < PIPELINE_REGISTERS ? number : -1;
}

/* What an instruction names, in order; a register of a list within braces counts as any other. */
typedef struct {
    int32_t count;
    int32_t number[2 * PIPELINE_REGISTERS];
    int32_t listed; /* within braces */
    bool shifts;
    bool moves_base; /* an address that is written back */
} operands_t;

static operands_t operands_of(const char *text)
{
    operands_t operands = {0};
    bool braces = false;
    while (*text != '\0') {
        char word[WORD];
        size_t length = 0;
        for (; isalnum((unsigned char)*text) && length + 1 < sizeof word; text++) {
            word[length++] = *text;
        }
        word[length] = '\0';
        const int32_t number = register_of(word);
        if (number >= 0 && operands.count < 2 * PIPELINE_REGISTERS) {
            operands.number[operands.count++] = number;
            operands.listed += braces ? 1 : 0;
        }
        operands.shifts = operands.shifts || strcmp(word, "lsl") == 0 || strcmp(word, "lsr") == 0 ||
                          strcmp(word, "asr") == 0 || strcmp(word, "ror") == 0 || strcmp(word, "rrx") == 0;
        if (length == 0) {
            braces = (braces || *text == '{') && *text != '}';
            operands.moves_base = operands.moves_base || *text == '!' || begins(text, "],");
            text++;
        }
    }
    return operands;
}

/* Registers that it writes, of those it names, from the first one on; of a list those, which come last. */
static int32_t results_of(kind_t kind, const char *name, const operands_t *operands)
{
    const bool pair = begins(name, "ldrd") || begins(name, "umull") || begins(name, "umlal") ||
                      begins(name, "smull") || begins(name, "smlal") || begins(name, "umaal");
    const bool none = kind == STORE || kind == BRANCH || kind == FIXED_BRANCH || begins(name, "cmp") ||
                      begins(name, "cmn") || begins(name, "tst") || begins(name, "teq");
    const int32_t wanted = operands->listed > 0 ? operands->listed : pair ? 2 : 1;
    return none || wanted > operands->count ? 0 : wanted;
}

/* Until the result is there: of vectors and floating point, whose registers are not looked at. */
static uint32_t float_cycles(const char *name)
{
    if (begins(name, "vdiv") || begins(name, "vsqrt")) {
        return 31;
    }
    const bool multiplies = begins(name, "vmul") || begins(name, "vml") || begins(name, "vfm") ||
                            begins(name, "vnml") || begins(name, "vnmul") || begins(name, "vfnm");
    return multiplies ? 11 : 4;
}

/* Cycles for which no other instruction is issued: a list of words goes two by two. */
static uint32_t issue_cycles(kind_t kind, const char *name, const operands_t *operands)
{
    switch (kind) {
    case DIVIDE:
        return DIVISION_CYCLES;
    case FLOAT:
        return float_cycles(name);
    case LOAD:
    case STORE:
        return (uint32_t)(operands->listed > 2 ? (operands->listed + 1) / 2 : 1);
    default:
        return 1;
    }
}

/* Cycles from the issue until another instruction may compute with the result. */
static uint32_t latency(kind_t kind, uint32_t issue)
{
    return kind == ALU ? 1 : issue + 1;
}

static uint32_t later(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static void wait_for_operands(pipeline_t *pipeline, bool early, const operands_t *operands)
{
    for (int32_t k = 0; k < operands->count; k++) {
        const int32_t number = operands->number[k];
        pipeline->now = later(pipeline->now, early ? pipeline->settled[number] : pipeline->ready[number]);
    }
}

static void write_results(pipeline_t *pipeline, kind_t kind, uint32_t issue, const operands_t *operands,
                          int32_t results)
{
    const int32_t first = operands->listed > 0 ? operands->count - operands->listed : 0;
    for (int32_t k = first; k < first + results; k++) {
        const int32_t number = operands->number[k];
        pipeline->ready[number] = pipeline->now + latency(kind, issue);
        pipeline->settled[number] = pipeline->now + later(latency(kind, issue), 2);
    }
    for (int32_t k = 0; operands->moves_base && k < operands->count; k++) {
        const int32_t number = operands->number[k];
        pipeline->settled[number] = later(pipeline->settled[number], pipeline->now + 2);
    }
}

static bool writes_pc(const operands_t *operands, int32_t results)
{
    for (int32_t k = 0; k < operands->count; k++) {
        if (results > 0 && operands->number[k] == PC && (k == 0 || operands->listed > 0)) {
            return true;
        }
    }
    return false;
}

void pipeline_issue(pipeline_t *pipeline, const char *instruction)
{
    char name[WORD] = {0};
    const size_t length = strcspn(instruction, " \t");
    memcpy(name, instruction, length < WORD ? length : WORD - 1);
    const char *text = instruction + length + strspn(instruction + length, " \t");
    const kind_t kind = kind_of(name, text);
    const operands_t operands = operands_of(text);
    const int32_t results = results_of(kind, name, &operands);
    const uint32_t issue = issue_cycles(kind, name, &operands);
    const bool early = kind == LOAD || kind == STORE || operands.shifts;
    wait_for_operands(pipeline, early, &operands);
    write_results(pipeline, kind, issue, &operands, results);
    const bool unforeseen = kind == BRANCH || writes_pc(&operands, results);
    pipeline->now += issue + (unforeseen ? STAGES : 0);
}

uint32_t pipeline_cycles(const pipeline_t *pipeline)
{
    uint32_t end = pipeline->now;
    for (int32_t k = 0; k < PIPELINE_REGISTERS; k++) {
        end = later(end, pipeline->settled[k]);
    }
    return end;
}
