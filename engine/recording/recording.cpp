#include "engine/recording/recording.h"

#include <utility>

#include "engine/saving/fields.h"
#include "engine/saving/sealed.h"

namespace weft {
namespace {

/// The version changes with the fields.
constexpr Kind kStartPart{{'w', 'e', 'f', 't', ' ', 'r', 'e', 'c'}, "recording", 2};
constexpr Kind kCallsPart{{'w', 'e', 'f', 't', 'c', 'a', 'l', 'l'}, "calls", 2};
constexpr Kind kResultPart{{'w', 'e', 'f', 't', 's', 't', 'e', 'p'}, "result", 1};
constexpr Kind kEndPart{{'w', 'e', 'f', 't', ' ', 'e', 'n', 'd'}, "end", 1};

}  // namespace

void visit_fields(Is<RecordedStart> auto& start, auto& archive) {
  auto& [version, note, settings, model, state, hash] = start;
  archive(version, note, settings, model, state, hash);
}

void visit_fields(Is<RecordedCalls> auto& calls, auto& archive) {
  auto& [dt, model, state] = calls;
  archive(dt, model, state);
}

void visit_fields(Is<RecordedResult> auto& result, auto& archive) {
  auto& [status, hash] = result;
  archive(status, hash);
}

namespace {

// ------------------------------------------------------------------------------------ writing

std::vector<std::byte> part(const Kind& kind, const auto& content) {
  ArchiveWriter archive;
  archive(content);
  const std::vector<std::byte> sealed = seal(kind, std::move(archive).bytes());
  ArchiveWriter whole;
  whole(sealed);  // its size goes before it
  return std::move(whole).bytes();
}

// ------------------------------------------------------------------------------------ reading

Result<void> parse_part(const Kind& kind, std::span<const std::byte> bytes, auto& content) {
  const auto unsealed = unseal(kind, bytes);
  if (!unsealed) return Error{unsealed.error()};
  ArchiveReader archive(unsealed.value());
  archive(content);
  if (!archive.is_done()) return Error{std::string(kind.name) + ": holds what cannot be"};
  return {};
}

/// The parts of a file, one after the other.
class RecordingParts {
 public:
  explicit RecordingParts(std::span<const std::byte> bytes) : left_(bytes) {}

  enum class Next { part, end, cut_off, damaged };
  Next look() const {
    constexpr std::size_t kSize = 8, kSeal = 28, kSizeInSeal = 12;
    if (left_.empty()) return Next::end;
    if (left_.size() < kSize + kSeal) return Next::cut_off;
    const std::uint64_t size = load<std::uint64_t>(left_.data());
    if (size <= left_.size() - kSize) return Next::part;
    // The seal has the size again: a file that is cut off has the same there.
    const std::uint64_t again = load<std::uint64_t>(left_.data() + kSize + kSizeInSeal);
    return size - kSeal == again ? Next::cut_off : Next::damaged;
  }
  std::span<const std::byte> take() {
    const auto size = static_cast<std::size_t>(load<std::uint64_t>(left_.data()));
    const auto taken = left_.subspan(8, size);
    left_ = left_.subspan(8 + size);
    return taken;
  }
  bool is_empty() const { return left_.empty(); }

 private:
  std::span<const std::byte> left_;
};

bool is_of(const Kind& kind, std::span<const std::byte> part) { return bool(unseal(kind, part)); }

Result<void> add_step_part(std::span<const std::byte> part, std::vector<RecordedStep>& steps) {
  const bool is_within = !steps.empty() && !steps.back().result;
  if (!is_within || is_of(kCallsPart, part))
    return parse_part(kCallsPart, part, steps.emplace_back().calls);
  RecordedResult result;
  if (auto parsed = parse_part(kResultPart, part, result); !parsed) return parsed;
  if (name(result.status) == "unknown") return Error{"result: holds what cannot be"};
  steps.back().result = result;
  return {};
}

/// That a part after these belongs to.
std::size_t step_at(const std::vector<RecordedStep>& steps) {
  const bool is_within = !steps.empty() && !steps.back().result;
  return steps.size() + (is_within ? 0 : 1);
}

}  // namespace

std::string version_text() {
  return std::to_string(WEFT_VERSION_MAJOR) + "." + std::to_string(WEFT_VERSION_MINOR) + "." +
         std::to_string(WEFT_VERSION_PATCH);
}

std::vector<std::byte> bytes_of(const RecordedStart& start) { return part(kStartPart, start); }
std::vector<std::byte> bytes_of(const RecordedCalls& calls) { return part(kCallsPart, calls); }
std::vector<std::byte> bytes_of(const RecordedResult& result) { return part(kResultPart, result); }
std::vector<std::byte> bytes_of_end() { return part(kEndPart, std::uint8_t{0}); }

Result<Recording> parse_recording(std::span<const std::byte> bytes) {
  RecordingParts parts(bytes);
  if (parts.look() != RecordingParts::Next::part)
    return Error{"is not a recording of weft's, or cut off"};
  Recording recording;
  if (auto parsed = parse_part(kStartPart, parts.take(), recording.start); !parsed)
    return Error{parsed.error()};
  while (true) {
    const std::string place = "is damaged in step " + std::to_string(step_at(recording.steps));
    const auto next = parts.look();
    if (next == RecordingParts::Next::damaged) return Error{place};
    if (next != RecordingParts::Next::part) return recording;
    const auto part = parts.take();
    if (is_of(kEndPart, part)) break;
    if (auto added = add_step_part(part, recording.steps); !added) return Error{place};
  }
  if (!parts.is_empty()) return Error{"goes on after its end"};
  recording.is_finished = true;
  return recording;
}

}  // namespace weft
