/* ale-replay: a recorded log through the code of the firmware, offline. */
#include "lab/replay/options.h"
#include "lab/replay/replay.h"

int main(int argc, char **argv)
{
    return ale::with_options(argc, argv, [](const ale::ReplayOptions &options) {
        ale::replay(options);
        return 0;
    });
}
