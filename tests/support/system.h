/// What tests ask of the operating system: system_linux.cpp, system_windows.cpp.
#pragma once

#include <cstddef>

namespace weft::test {

/// A variable of the environment; nullptr takes it away.
void set_environment(const char* name, const char* value);

/// On which the calling thread may run; -1 if that cannot be known.
int processors_allowed();

/// Threads that this process has; -1 if that cannot be known.
std::ptrdiff_t threads_alive();

}  // namespace weft::test
