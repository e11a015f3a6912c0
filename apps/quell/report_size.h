// How large a report will be, before it is made.
#pragma once

#include "report_data.h"

namespace quell::app {

/// Bytes of the file, by what noise takes; smooth images, masks and ids take less.
double estimate_bytes(const Report& report);

}  // namespace quell::app
