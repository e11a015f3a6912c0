// What a run keeps in memory beside the images of its pool, so that --memory holds for the whole process.
#pragma once

#include <cstddef>

#include "job.h"

namespace quell::app {

/// Makes the C library give large blocks back to the system when they are freed: it would otherwise learn to keep them, and what
/// a process holds would depend on what it has done before. Once, at the start.
void steady_allocation();

/// Bytes resident now; 0 where the system does not tell.
std::size_t resident_bytes();
/// The most that were resident at a time so far; 0 where the system does not tell.
std::size_t peak_resident_bytes();

/// Upper bound of what a run needs beside images: the program as it is loaded now, and for each thread its stack and the rows of
/// a file that it decodes or encodes. `threads` as in SessionOptions. `measures`: images are compared with a reference as well.
std::size_t estimate_beside_images(const Job& job, int threads, bool measures);

}  // namespace quell::app
