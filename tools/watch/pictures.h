/* The map that came over LCM, and the way driven, as pictures. */
#ifndef WATCH_PICTURES_H
#define WATCH_PICTURES_H

#include <string>

#include "watch/record.h"

namespace watch
{

/* Throws std::invalid_argument when the file's ending names no kind of picture that is known. */
void require_picture_kind(const std::string &path);

/* Throws std::runtime_error naming the file and the reason. */
void write_picture(const Record &record, const std::string &path);

} // namespace watch

#endif
