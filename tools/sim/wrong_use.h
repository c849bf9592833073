/* The command line asks for what cannot be: exit code 2. */
#ifndef ALE_SIM_WRONG_USE_H
#define ALE_SIM_WRONG_USE_H

#include <stdexcept>

namespace sim
{

class WrongUse : public std::runtime_error
{
  public:
    using std::runtime_error::runtime_error;
};

} // namespace sim

#endif
