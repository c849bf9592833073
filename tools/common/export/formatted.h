/* printf into a string. */
#ifndef EXPORT_FORMATTED_H
#define EXPORT_FORMATTED_H

#include <string>

namespace ale
{

/* At most 255 characters; what is longer is cut. */
__attribute__((format(printf, 1, 2))) std::string formatted(const char *pattern, ...);

} // namespace ale

#endif
