#include "engine/c_interface/calls.h"

#include <weft/weft.h>

#include <algorithm>
#include <string>

namespace weft::c_interface {
namespace {

thread_local char last_message[1024] = "";

}  // namespace

weft_result fail(weft_result result, std::string_view message) noexcept {
  const std::size_t length = std::min(message.size(), sizeof last_message - 1);
  std::copy_n(message.data(), length, last_message);
  last_message[length] = 0;
  return result;
}

Result<void> given(std::initializer_list<Pointer> pointers) {
  for (const Pointer& p : pointers) {
    if (p.pointer == nullptr) return Error{std::string(p.name) + ": must not be NULL"};
  }
  return {};
}

}  // namespace weft::c_interface

const char* weft_last_message(void) { return weft::c_interface::last_message; }

void weft_version(int* major, int* minor, int* patch) {
  if (major != nullptr) *major = WEFT_VERSION_MAJOR;
  if (minor != nullptr) *minor = WEFT_VERSION_MINOR;
  if (patch != nullptr) *patch = WEFT_VERSION_PATCH;
}
