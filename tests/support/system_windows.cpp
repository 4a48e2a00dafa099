// First, since the other header needs it.
#include <windows.h>
// Second.
#include <tlhelp32.h>

#include <bit>
#include <cstdlib>

#include "tests/support/system.h"

namespace weft::test {

void set_environment(const char* name, const char* value) {
  _putenv_s(name, value == nullptr ? "" : value);  // an empty one is taken away
}

int processors_allowed() {
  GROUP_AFFINITY allowed;
  return GetThreadGroupAffinity(GetCurrentThread(), &allowed) ? std::popcount(allowed.Mask) : -1;
}

std::ptrdiff_t threads_alive() {
  const HANDLE all = CreateToolhelp32Snapshot(TH32CS_SNAPTHREAD, 0);
  if (all == INVALID_HANDLE_VALUE) return -1;
  const DWORD own = GetCurrentProcessId();
  THREADENTRY32 thread;
  thread.dwSize = sizeof thread;
  std::ptrdiff_t count = 0;
  for (BOOL found = Thread32First(all, &thread); found; found = Thread32Next(all, &thread)) {
    if (thread.th32OwnerProcessID == own) ++count;
  }
  CloseHandle(all);
  return count;
}

}  // namespace weft::test
