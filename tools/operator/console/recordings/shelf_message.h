/* The console's folders as JSON for its page: WEB_SOCKET.md lists the fields. */
#ifndef CONSOLE_SHELF_MESSAGE_H
#define CONSOLE_SHELF_MESSAGE_H

#include <string>

#include "operator/console/recordings/archive.h"

namespace console
{

/* refusal: why what the page asked for was not done; empty: it was. */
std::string shelf_message(const Contents &recordings, const Contents &flights, const Contents &maps,
                          const std::string &refusal);

} // namespace console

#endif
