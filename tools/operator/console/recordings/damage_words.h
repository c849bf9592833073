/* What of a recording is left out since it is damaged, for people: "2 damaged places, 5.8 kB, left out". */
#ifndef CONSOLE_DAMAGE_WORDS_H
#define CONSOLE_DAMAGE_WORDS_H

#include <string>

#include "operator/console/recordings/event_file.h"

namespace console
{

/* Of how many bytes is left out of it where that is not known, 0. Empty: no place. */
std::string damage_words(const Damage &damage);

} // namespace console

#endif
