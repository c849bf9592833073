#include "lcm/assembly.h"

#include <string.h>

static ale_partial_t *of_sender(ale_assembly_t *assembly, uint64_t from)
{
    for (int k = 0; k < ALE_ASSEMBLY_MESSAGES; k++) {
        if (assembly->partial[k].of > 0 && assembly->partial[k].from == from) {
            return &assembly->partial[k];
        }
    }
    return NULL;
}

/* A free place, or the one whose turn it is to be given up. */
static ale_partial_t *any_place(ale_assembly_t *assembly)
{
    for (int k = 0; k < ALE_ASSEMBLY_MESSAGES; k++) {
        if (assembly->partial[k].of == 0) {
            return &assembly->partial[k];
        }
    }
    assembly->refused++;
    assembly->turn = (assembly->turn + 1) % ALE_ASSEMBLY_MESSAGES;
    return &assembly->partial[assembly->turn];
}

static ale_partial_t *begin(ale_assembly_t *assembly, uint64_t from, const ale_datagram_t *part)
{
    ale_partial_t *partial = of_sender(assembly, from);
    if (partial) {
        assembly->refused++;
    } else {
        partial = any_place(assembly);
    }
    partial->from = from;
    partial->sequence = part->sequence;
    partial->size = part->size;
    partial->filled = 0;
    partial->next = 0;
    partial->of = part->of;
    memcpy(partial->channel, part->channel, strlen(part->channel) + 1);
    return partial;
}

static bool is_due(const ale_partial_t *partial, const ale_datagram_t *part)
{
    return partial->sequence == part->sequence && partial->size == part->size && partial->of == part->of &&
           partial->next == part->number && partial->filled == part->offset;
}

const ale_partial_t *ale_assembly_add(ale_assembly_t *assembly, uint64_t from, const ale_datagram_t *part)
{
    if (part->size > ALE_ASSEMBLY_BYTES) {
        assembly->refused++;
        return NULL;
    }
    ale_partial_t *partial = part->number == 0 ? begin(assembly, from, part) : of_sender(assembly, from);
    if (!partial || !is_due(partial, part)) {
        assembly->refused++;
        if (partial) {
            partial->of = 0;
        }
        return NULL;
    }
    memcpy(partial->bytes + partial->filled, part->bytes, part->count);
    partial->filled += (uint32_t)part->count;
    partial->next++;
    if (partial->next < partial->of) {
        return NULL;
    }
    partial->of = 0;
    assembly->refused += partial->filled < partial->size;
    return partial->filled == partial->size ? partial : NULL;
}
