/// The frame of every function of the C interface: no exception leaves it, and its error is the
/// message of the calling thread.
#pragma once

#include <weft/result.h>
#include <weft/weft_c.h>

#include <exception>
#include <initializer_list>
#include <new>
#include <string_view>
#include <utility>

namespace weft::c_interface {

/// Becomes the message of this thread, cut off where it is too long. Returns `result`.
weft_result fail(weft_result result, std::string_view message) noexcept;

inline constexpr std::string_view kOutOfMemory = "memory: there is none left";

/// Does `work`, which returns a Result<void>.
template <class Work>
weft_result call(const Work& work) noexcept {
  try {
    const Result<void> done = work();
    return done ? WEFT_OK : fail(WEFT_REFUSED, done.error());
  } catch (const std::bad_alloc&) {
    return fail(WEFT_OUT_OF_MEMORY, kOutOfMemory);
  } catch (const std::exception& exception) {
    return fail(WEFT_FAILED, exception.what());
  } catch (...) {
    return fail(WEFT_FAILED, "an exception that is none of the standard library's");
  }
}

struct Pointer {
  std::string_view name;
  const void* pointer;
};
/// Refuses the first that is null.
Result<void> given(std::initializer_list<Pointer> pointers);

/// For functions that return a value: 0 for a null handle.
template <class Handle, class Work>
auto ask(std::string_view name, const Handle* handle, const Work& work) noexcept
    -> decltype(work()) {
  decltype(work()) answer{};
  call([&]() -> Result<void> {
    if (auto r = given({{name, handle}}); !r) return r;
    answer = work();
    return {};
  });
  return answer;
}

/// Gives the caller a handle of what was made, or says why it was not.
template <class Handle, class Made>
Result<void> hand_over(Result<Made> made, Handle** out) {
  if (!made) return Error{made.error()};
  *out = new Handle{std::move(made).value()};
  return {};
}

}  // namespace weft::c_interface
