/// Calls of the C interface, and what holds after each: a result that is known, one line of message
/// where it is not WEFT_OK, and then nothing that was changed.
#pragma once

#include <weft/weft_c.h>

#include <cstddef>
#include <vector>

#include "tests/fuzz/checks.h"
#include "tests/support/c_handles.h"

namespace weft::fuzz {

using test::Owned;

/// Whether the call was done. What is refused is said in one line; there is no lack of memory, and
/// nothing that weft itself does wrong.
bool done(weft_result result);

/// What `make`, which takes the place for a handle, makes; null where it is refused.
template <class Handle, class Make>
Owned<Handle> made(const Make& make) {
  Handle* handle = nullptr;
  const bool is_made = done(make(&handle));
  check(is_made == (handle != nullptr), "a handle is given back exactly where the call was done");
  return Owned<Handle>(handle);
}

/// A struct of C with its defaults.
template <class Struct>
Struct initial(weft_result (*init)(Struct*, std::size_t)) {
  Struct it;
  check(init(&it, sizeof it) == WEFT_OK, "a struct is given its defaults");
  return it;
}

std::vector<std::byte> state_of(const weft_cloth* cloth);
/// A call that may change the cloth, and does not where it is refused.
template <class Call>
bool changed(weft_cloth* cloth, const Call& call) {
  const auto before = state_of(cloth);
  const bool is_done = done(call());
  check(is_done || state_of(cloth) == before, "a call that is refused changes nothing");
  return is_done;
}

/// A step that is done says truly whether it has changed the state, which is finite then.
void step(weft_cloth* cloth, double dt, const weft_jobs* jobs);

/// One thread after the other runs the jobs.
weft_jobs serial_jobs(int threads);

}  // namespace weft::fuzz
