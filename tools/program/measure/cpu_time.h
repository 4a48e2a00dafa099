/// Processor time, which other programs on the machine do not lengthen.
#pragma once

namespace weft::tools {

/// s, of this process so far, all of its threads together.
double cpu_seconds();
/// s, of the calling thread.
double thread_cpu_seconds();

}  // namespace weft::tools
