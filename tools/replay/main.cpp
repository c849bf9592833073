/* ale-replay: a recorded log through the code of the firmware, offline. */
#include "replay/options.h"
#include "replay/replay.h"

int main(int argc, char **argv)
{
    return ale::with_options(argc, argv, [](const ale::ReplayOptions &options) {
        ale::replay(options);
        return 0;
    });
}
