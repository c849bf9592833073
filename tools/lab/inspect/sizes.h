/* What the objects cost whose memory a caller of libale provides. */
#ifndef INSPECT_SIZES_H
#define INSPECT_SIZES_H

#include <string>

namespace inspect
{

/* A table in Markdown: type, bytes on this machine, how they are known, what it is for. */
std::string table_of_sizes();

} // namespace inspect

#endif
