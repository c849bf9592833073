/* The work of ale-merge --into and --versions: a building's map that is kept. */
#ifndef ALE_LAB_MERGE_INTO_H
#define ALE_LAB_MERGE_INTO_H

#include "lab/merge/options.h"

namespace merge
{

/* 0: all drives are in the map; 1: some are not. None of them joins: nothing is changed. Throws
 * std::runtime_error with one line. */
int merge_into(const Options &options);

/* Prints the versions of a kept map. Throws std::runtime_error with one line. */
int list_versions(const std::string &path);

} // namespace merge

#endif
