/* The work of ale-merge. */
#ifndef ALE_LAB_MERGE_MERGE_H
#define ALE_LAB_MERGE_MERGE_H

#include "lab/merge/options.h"

namespace merge
{

/* 0, or 1: not all drives are in the map. The same logs give the same bytes, in whatever order they are
 * named. Throws std::runtime_error with one line. */
int merge(const Options &options);

} // namespace merge

#endif
