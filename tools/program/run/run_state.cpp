#include "tools/program/run/run_state.h"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <utility>

#include "engine/model/model.h"
#include "engine/model/saved_model.h"
#include "engine/saving/archive.h"
#include "engine/saving/sealed.h"
#include "tools/program/files/pending_file.h"
#include "tools/program/files/text_file.h"

namespace weft::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kBetween{1};
/// The version changes with the fields below.
constexpr Kind kRun{{'w', 'e', 'f', 't', ' ', 'r', 'u', 'n'}, "state of a run", 2};

void visit_fields(Is<RunState> auto& state, auto& archive) {
  auto& [frame, dt, cloth, scene, tears, torn] = state;
  archive(frame, dt, cloth, scene, tears, torn);
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

StateFile::StateFile(std::string path, double dt, const Model& scene)
    : path_(std::move(path)), dt_(dt), scene_(fingerprint(scene)), last_(Clock::now()) {}

Result<StateFile> StateFile::open(const std::string& path, double dt, const Model& scene) {
  if (auto file = PendingFile::open(path); !file) return Error{file.error()};
  return StateFile(path, dt, scene);
}

void StateFile::add_frame(const Cloth& cloth, int frame) {
  if (Clock::now() - last_ < kBetween) return;
  add_last(cloth, frame);
  last_ = Clock::now();
}

void StateFile::add_last(const Cloth& cloth, int frame) {
  if (!written_) return;
  RunState state{.frame = frame, .dt = dt_, .cloth = cloth.save_state(), .scene = scene_};
  if (const auto model = cloth.model(); model->tears > 0) {
    state.tears = model->tears;
    state.torn = save_model(*model);
  }
  const std::vector<std::byte> bytes = bytes_of(state);
  written_ = write_file(path_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace weft::tools
