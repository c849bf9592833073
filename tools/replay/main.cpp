/* ale-replay: a recorded log through the code of the firmware, offline. */
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "replay/options.h"
#include "replay/replay.h"

int main(int argc, char **argv)
{
    ale::ReplayOptions options;
    const int code = ale::parse_options(argc, argv, options);
    if (code >= 0) {
        return code;
    }
    try {
        ale::replay(options);
        return 0;
    } catch (const std::invalid_argument &error) {
        std::fprintf(stderr, "ale-replay: %s\n", error.what());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-replay: %s\n", error.what());
        return 1;
    }
}
