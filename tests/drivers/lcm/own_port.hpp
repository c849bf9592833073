/* LCM on a port of this process, so that tests run side by side, also with those of
 * tools/library/python/lcm_url.py; it stays on this machine. */
#ifndef TESTS_DRIVERS_LCM_OWN_PORT_HPP
#define TESTS_DRIVERS_LCM_OWN_PORT_HPP

#include <string>

#include <unistd.h>

inline std::string own_lcm_url()
{
    return "udpm://239.255.76.67:" + std::to_string(10000 + getpid() % 10000) + "?ttl=0";
}

#endif
