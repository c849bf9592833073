/* The map that came over LCM, and the way driven, as pictures. */
#ifndef WATCH_PICTURES_H
#define WATCH_PICTURES_H

#include <string>

#include "operator/watch/record.h"

namespace watch
{

/* Throws std::runtime_error naming the file and the reason. */
void write_picture(const Record &record, const std::string &path);

} // namespace watch

#endif
