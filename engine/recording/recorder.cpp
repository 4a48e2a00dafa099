#include "engine/recording/recorder.h"

#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "engine/saving/sealed.h"
#include "engine/step/saved_state.h"
#include "engine/step/state_hash.h"
#include "engine/validation.h"

namespace weft {
namespace {

/// Without the seal, whose checksum differs wherever anything does.
Result<std::span<const std::byte>> content(std::span<const std::byte> state) {
  return unseal(kSavedState, state);
}

Error not_written(const std::string& path) {
  return refuse("path", "cannot be written", in_one_line(path) + ": " + std::strerror(errno));
}

}  // namespace

Recorder::Recorder(std::string path, std::FILE* file, std::shared_ptr<const Model> model)
    : path_(std::move(path)), file_(file), model_(std::move(model)) {}

Result<std::unique_ptr<Recorder>> Recorder::begin(const std::string& path, std::string_view note,
                                                  const Settings& asked, const State& state) {
  const RecordedStart start{.version = version_text(),
                            .note = std::string(note),
                            .settings = asked,
                            .model = save_model(*state.model),
                            .state = save_state(state),
                            .hash = state_hash(state)};
  std::FILE* const file =
      std::fopen(path.c_str(), "wbe");  // e: a process of the host does not inherit it
  if (file == nullptr) return not_written(path);
  std::unique_ptr<Recorder> recorder(new Recorder(path, file, state.model));
  recorder->add_part(bytes_of(start));
  if (!recorder->written_) return Error{recorder->written_.error()};
  recorder->state_ = start.state;
  return recorder;
}

void Recorder::add_part(std::span<const std::byte> part) {
  if (!written_) return;
  const bool complete = std::fwrite(part.data(), 1, part.size(), file_.get()) == part.size() &&
                        std::fflush(file_.get()) == 0;
  if (!complete) written_ = not_written(path_);
}

/// A part that was not written is missing for all that follows.
void Recorder::try_to(const auto& write) noexcept {
  try {
    if (written_) write();
  } catch (const std::bad_alloc&) {
    written_ = Error{"out of memory"};  // short enough to need none
  }
}

void Recorder::before_step(const State& state, double dt) noexcept {
  try_to([&] {
    std::vector<std::byte> now = save_state(state);
    RecordedCalls calls{dt, {}, patches(content(state_).value(), content(now).value())};
    if (state.model != model_) calls.model = save_model(*state.model);
    add_part(bytes_of(calls));
    model_ = state.model;
    state_ = std::move(now);
  });
}

void Recorder::after_step(const State& state, Status status) noexcept {
  try_to([&] {
    state_ = save_state(state);
    add_part(bytes_of(RecordedResult{status, state_hash(state)}));
  });
}

Result<void> Recorder::end() {
  try_to([&] { add_part(bytes_of_end()); });
  return written_;
}

Result<std::vector<std::byte>> patched_state(std::span<const std::byte> before,
                                             std::span<const Patch> patches) {
  const auto old = content(before);
  if (!old) return Error{old.error()};
  const auto changed = patched(old.value(), patches);
  if (!changed) return Error{changed.error()};
  return seal(kSavedState, changed.value());
}

}  // namespace weft
