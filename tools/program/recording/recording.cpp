#include "tools/program/recording/recording.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/saving/archive.h"
#include "engine/saving/fields.h"
#include "engine/saving/sealed.h"
#include "tools/program/files/json_reading.h"
#include "tools/program/files/text_file.h"
#include "tools/program/recording/settings_json.h"
#include "tools/program/text/parse.h"

namespace weft::tools {

void visit_fields(Is<PlacedPin> auto& pin, auto& archive) {
  auto& [particle, position] = pin;
  archive(particle, position);
}
void visit_fields(Is<PosedBody> auto& body, auto& archive) {
  auto& [id, pose] = body;
  archive(id, pose);
}
void visit_fields(Is<DeformedBody> auto& body, auto& archive) {
  auto& [id, vertices] = body;
  archive(id, vertices);
}
void visit_fields(Is<FrameCalls> auto& calls, auto& archive) {
  auto& [pins, bodies, deformed] = calls;
  archive(pins, bodies, deformed);
}
void visit_fields(Is<RecordedResult> auto& result, auto& archive) {
  auto& [status, hash] = result;
  archive(status, hash);
}

namespace {

/// What a start is as bytes: what people may read is JSON.
struct SavedStart {
  std::vector<char> description;
  std::vector<std::byte> model, state;
  std::uint64_t hash = 0;
};
void visit_fields(Is<SavedStart> auto& start, auto& archive) {
  auto& [description, model, state, hash] = start;
  archive(description, model, state, hash);
}

/// The version changes with the fields.
constexpr Kind kStartPart{{'w', 'e', 'f', 't', ' ', 'r', 'e', 'c'}, "recording", 1};
constexpr Kind kCallsPart{{'w', 'e', 'f', 't', 'c', 'a', 'l', 'l'}, "calls", 1};
constexpr Kind kResultPart{{'w', 'e', 'f', 't', 's', 't', 'e', 'p'}, "result", 1};
constexpr Kind kEndPart{{'w', 'e', 'f', 't', ' ', 'e', 'n', 'd'}, "end", 1};

// ------------------------------------------------------------------------------------ writing

std::vector<std::byte> part(const Kind& kind, const auto& content) {
  ArchiveWriter archive;
  archive(content);
  const std::vector<std::byte> sealed = seal(kind, std::move(archive).bytes());
  ArchiveWriter whole;
  whole(sealed);  // its size goes before it
  return std::move(whole).bytes();
}

Json description_of(const RecordedStart& start) {
  return {{"weft", start.version},
          {"scene", start.scene},
          {"isa", name(start.isa)},
          {"frames_before", start.frames_before},
          {"frames", start.frames},
          {"dt", start.dt},
          {"settings", settings_json(start.settings)}};
}

// ------------------------------------------------------------------------------------ reading

int read_count(const Json& json, const std::string& place) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > 2'000'000'000u)
    refuse(place, "a whole number", json);
  return json.get<int>();
}

std::string read_text(const Json& json, const std::string& place) {
  if (!json.is_string()) refuse(place, "a text", json);
  return json.get<std::string>();
}

Isa read_isa(const Json& json) {
  const auto isa = parse_choice<Isa>("isa", read_text(json, "isa"));
  if (!isa) throw Refused{isa.error()};
  return isa.value();
}

void read_description(const Json& json, RecordedStart& start) {
  if (!json.is_object()) refuse("description", "an object", json);
  const auto value = [&](const char* key) -> const Json& {
    if (!json.contains(key)) throw Refused{fmt::format("{}: is missing", key)};
    return json[key];
  };
  start.version = read_text(value("weft"), "weft");
  start.scene = read_text(value("scene"), "scene");
  start.isa = read_isa(value("isa"));
  start.frames_before = read_count(value("frames_before"), "frames_before");
  start.frames = read_count(value("frames"), "frames");
  start.dt = read_number(value("dt"), "dt");
  start.settings = read_settings(value("settings"), "settings");
}

Result<void> parse_description(std::string_view text, RecordedStart& start) {
  try {
    read_description(Json::parse(text), start);
  } catch (const Refused& refused) {
    return Error{refused.message};
  } catch (const Json::exception& exception) {
    return Error{plain_message(exception, text)};
  }
  return {};
}

Result<void> parse_part(const Kind& kind, std::span<const std::byte> bytes, auto& content) {
  const auto unsealed = unseal(kind, bytes);
  if (!unsealed) return Error{unsealed.error()};
  ArchiveReader archive(unsealed.value());
  archive(content);
  if (!archive.is_done()) return Error{fmt::format("{}: holds what cannot be", kind.name)};
  return {};
}

Result<RecordedStart> parse_start(std::span<const std::byte> bytes) {
  SavedStart saved;
  if (auto parsed = parse_part(kStartPart, bytes, saved); !parsed) return Error{parsed.error()};
  RecordedStart start;
  auto described = parse_description({saved.description.data(), saved.description.size()}, start);
  if (!described) return Error{described.error()};
  start.model = std::move(saved.model);
  start.state = std::move(saved.state);
  start.hash = saved.hash;
  return start;
}

/// The parts of a file, one after the other.
class Parts {
 public:
  explicit Parts(std::span<const std::byte> bytes) : left_(bytes) {}

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

bool is_end(std::span<const std::byte> part) { return unseal(kEndPart, part).operator bool(); }

Result<void> add_frame_part(std::span<const std::byte> part, std::vector<RecordedFrame>& frames) {
  const bool wants_result = !frames.empty() && !frames.back().result;
  if (!wants_result) return parse_part(kCallsPart, part, frames.emplace_back().calls);
  RecordedResult result;
  if (auto parsed = parse_part(kResultPart, part, result); !parsed) return parsed;
  if (name(result.status) == "unknown") return Error{"result: holds what cannot be"};
  frames.back().result = result;
  return {};
}

/// The frame that a part after these belongs to.
int frame_at(const Recording& recording) {
  const auto& frames = recording.frames;
  const bool is_within = !frames.empty() && !frames.back().result;
  return recording.start.frames_before + static_cast<int>(frames.size()) + (is_within ? 0 : 1);
}

}  // namespace

std::string version_text() {
  return fmt::format("{}.{}.{}", WEFT_VERSION_MAJOR, WEFT_VERSION_MINOR, WEFT_VERSION_PATCH);
}

std::vector<std::byte> bytes_of(const RecordedStart& start) {
  const std::string description = description_of(start).dump();
  return part(
      kStartPart,
      SavedStart{{description.begin(), description.end()}, start.model, start.state, start.hash});
}
std::vector<std::byte> bytes_of(const FrameCalls& calls) { return part(kCallsPart, calls); }
std::vector<std::byte> bytes_of(const RecordedResult& result) { return part(kResultPart, result); }
std::vector<std::byte> bytes_of_end() { return part(kEndPart, std::uint8_t{0}); }

Result<Recording> parse_recording(std::span<const std::byte> bytes) {
  Parts parts(bytes);
  if (parts.look() != Parts::Next::part) return Error{"is not a recording of weft's, or cut off"};
  auto start = parse_start(parts.take());
  if (!start) return Error{start.error()};
  Recording recording{std::move(start).value(), {}, false};
  while (true) {
    const int frame = frame_at(recording);
    const auto next = parts.look();
    if (next == Parts::Next::damaged) return Error{fmt::format("is damaged in frame {}", frame)};
    if (next != Parts::Next::part) return recording;
    const auto part = parts.take();
    if (is_end(part)) break;
    if (auto added = add_frame_part(part, recording.frames); !added)
      return Error{fmt::format("is damaged in frame {}", frame)};
  }
  if (!parts.is_empty()) return Error{"goes on after its end"};
  recording.is_finished = true;
  return recording;
}

Result<Recording> read_recording(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto recording = parse_recording(std::as_bytes(std::span(text.value())));
  if (!recording) return Error{fmt::format("'{}': {}", path, recording.error())};
  return recording;
}

RecordingFile::RecordingFile(std::string path, std::FILE* file)
    : path_(std::move(path)), file_(file) {}

Result<RecordingFile> RecordingFile::open(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "abe");
  if (file == nullptr)
    return Error{fmt::format("cannot write '{}': {}", path, std::strerror(errno))};
  return RecordingFile(path, file);
}

void RecordingFile::add_part(std::span<const std::byte> part) {
  if (!written_) return;
  const bool is_emptied = std::exchange(has_part_, true) ||
                          ftruncate(fileno(file_.get()), 0) == 0 ||
                          errno == EINVAL;  // a device has nothing to lose
  const bool complete = is_emptied &&
                        std::fwrite(part.data(), 1, part.size(), file_.get()) == part.size() &&
                        std::fflush(file_.get()) == 0;
  if (!complete)
    written_ = Error{fmt::format("cannot write '{}': {}", path_, std::strerror(errno))};
}

Result<void> RecordingFile::finish() {
  add_part(bytes_of_end());
  return written_;
}

}  // namespace weft::tools
