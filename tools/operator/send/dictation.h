/* Commands from the standard input, one a line, for a program that gives many: each is answered by one line
 * on the standard output, in their order: "obeyed WORDS" or "refused WORDS". Set points (drive) are answered
 * as soon as they are sent. */
#ifndef SEND_DICTATION_H
#define SEND_DICTATION_H

#include <string>
#include <vector>

#include "operator/send/robot_link.h"

namespace send
{

/* The words of a line; blanks part them. */
std::vector<std::string> words_of(const std::string &line);

/* Until the input ends or a signal comes. alone: no other robot needs to be looked for. */
void obey_dictation(RobotLink &link, bool alone);

} // namespace send

#endif
