#include "tools/program/run/run_state.h"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <utility>

#include "engine/saving/archive.h"
#include "engine/saving/sealed.h"
#include "tools/program/files/pending_file.h"
#include "tools/program/files/text_file.h"

namespace weft::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kBetween{1};
/// The version changes with the fields below.
constexpr Kind kRun{{'w', 'e', 'f', 't', ' ', 'r', 'u', 'n'}, "state of a run", 1};

void visit_fields(Is<RunState> auto& state, auto& archive) {
  auto& [frame, dt, cloth] = state;
  archive(frame, dt, cloth);
}

}  // namespace

Result<RunState> parse_run_state(std::span<const std::byte> bytes) {
  const auto content = unseal(kRun, bytes);
  if (!content) return Error{content.error()};
  ArchiveReader archive(content.value());
  RunState state;
  visit_fields(state, archive);
  if (!archive.is_done() || state.frame < 0) return Error{"holds what cannot be"};
  return state;
}

std::vector<std::byte> bytes_of(const RunState& state) {
  ArchiveWriter archive;
  visit_fields(state, archive);
  return seal(kRun, std::move(archive).bytes());
}

Result<RunState> read_run_state(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto state = parse_run_state(std::as_bytes(std::span(text.value())));
  if (!state) return Error{fmt::format("'{}': {}", path, state.error())};
  return state;
}

StateFile::StateFile(std::string path, double dt)
    : path_(std::move(path)), dt_(dt), last_(Clock::now()) {}

Result<StateFile> StateFile::open(const std::string& path, double dt) {
  if (auto file = PendingFile::open(path); !file) return Error{file.error()};
  return StateFile(path, dt);
}

void StateFile::add_frame(const Cloth& cloth, int frame) {
  if (Clock::now() - last_ < kBetween) return;
  add_last(cloth, frame);
  last_ = Clock::now();
}

void StateFile::add_last(const Cloth& cloth, int frame) {
  if (!written_) return;
  const std::vector<std::byte> bytes = bytes_of({frame, dt_, cloth.save_state()});
  written_ = write_file(path_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace weft::tools
