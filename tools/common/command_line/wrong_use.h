/* The command line, or a configuration, asks for what cannot be: exit code 2. */
#ifndef ALE_COMMON_COMMAND_LINE_WRONG_USE_H
#define ALE_COMMON_COMMAND_LINE_WRONG_USE_H

#include <stdexcept>

namespace cli
{

class WrongUse : public std::invalid_argument
{
  public:
    using std::invalid_argument::invalid_argument;
};

} // namespace cli

#endif
