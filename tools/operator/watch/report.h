/* The record in words and files. The writers throw std::runtime_error naming the file and the reason. */
#ifndef WATCH_REPORT_H
#define WATCH_REPORT_H

#include <string>

#include "operator/watch/record.h"

namespace watch
{

/* One line: time, state, pose, what is seen, worst stage, drops, latency. silent_s: since the last pose. */
std::string status_line(const Record &record, double elapsed_s, double silent_s);

/* One line: how many poses, how many missing, in which states. */
std::string summary_line(const Record &record);

/* TUM format: time in seconds, map pose as published at that moment; one line a pose. */
void write_trajectory(const Record &record, const std::string &path);

/* The map and the way driven, of the kind that the name's ending says. */
void write_picture(const Record &record, const std::string &path);

/* One row a pose, header first; README.md names the columns. */
void write_csv(const Record &record, const std::string &path);

} // namespace watch

#endif
