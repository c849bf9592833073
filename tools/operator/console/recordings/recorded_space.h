/* What the scans of a recording saw, laid out in its map. */
#ifndef CONSOLE_RECORDED_SPACE_H
#define CONSOLE_RECORDED_SPACE_H

#include "common/export/scan_cloud.h"
#include "operator/console/recordings/descriptor.h"

namespace console
{

/* Reads the recording through: seconds for an hour of driving. */
ale::ScanCloud seen_in(const Descriptor &file);

} // namespace console

#endif
