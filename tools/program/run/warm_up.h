/// Threads at work before anything is timed.
#pragma once

namespace weft::tools {

/// Keeps the present arena busy until so many of its threads have a processor each, 0.05 s at most:
/// Linux may leave a new thread on its creator's processor for tens of milliseconds.
void warm_up(int threads);

}  // namespace weft::tools
