#include "tools/program/files/pending_file.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace weft::tools {
namespace {

// The temporary names that a signal handler must remove. A handler may neither lock nor allocate,
// hence this table of plain pointers. A file beyond its end is only not removed on an interrupt.
std::array<std::atomic<const char*>, 32> pending_names{};
static_assert(std::atomic<const char*>::is_always_lock_free);

void remember(const char* name) {
  for (auto& slot : pending_names) {
    const char* expected = nullptr;
    if (slot.compare_exchange_strong(expected, name)) return;
  }
}

void forget(const char* name) {
  for (auto& slot : pending_names) {
    const char* expected = name;
    if (slot.compare_exchange_strong(expected, nullptr)) return;
  }
}

/// Of no other file, of this process or another, that is under way to the same place.
std::string temporary_of(const std::string& path) {
  static std::atomic<unsigned> count{0};
  return fmt::format("{}.{}.{}.part", path, getpid(), count++);
}

/// Through symbolic links: they stay, and what they lead to is written.
std::string followed(const std::string& path) {
  constexpr int kMostLinks = 40;  // as Linux follows
  std::filesystem::path place = path;
  std::error_code failure;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(place, failure); ++i) {
    place = place.parent_path() / std::filesystem::read_symlink(place, failure);
  }
  return place.string();
}

}  // namespace

struct PendingFile::State {
  std::string named;      ///< as the caller has it
  std::string path;       ///< what that leads to
  std::string temporary;  ///< empty for a device or pipe, which is written in place
  std::FILE* stream = nullptr;
  int failure = 0;  ///< errno of the first failed write

  ~State() {
    if (stream != nullptr) std::fclose(stream);
    if (temporary.empty()) return;
    unlink(temporary.c_str());
    forget(temporary.c_str());
  }
};

PendingFile::PendingFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PendingFile::PendingFile(PendingFile&&) noexcept = default;
PendingFile& PendingFile::operator=(PendingFile&&) noexcept = default;
PendingFile::~PendingFile() = default;

Result<PendingFile> PendingFile::open(const std::string& path) {
  const auto refused = [&] {
    return Error{fmt::format("cannot write '{}': {}", path, std::strerror(errno))};
  };
  struct stat place {};
  const bool exists = stat(path.c_str(), &place) == 0;
  if (!exists && errno == ELOOP) return refused();
  auto state = std::make_unique<State>();
  state->named = state->path = path;
  if (!exists || S_ISREG(place.st_mode)) {
    state->path = followed(path);
    state->temporary = temporary_of(state->path);
    remember(state->temporary.c_str());
  }
  const std::string& name = state->temporary.empty() ? path : state->temporary;
  state->stream = std::fopen(name.c_str(), "wbe");
  if (state->stream == nullptr) return refused();
  constexpr mode_t kPermissions = 07777;
  if (exists && !state->temporary.empty() &&
      fchmod(fileno(state->stream), place.st_mode & kPermissions) != 0) {
    return refused();
  }
  return PendingFile(std::move(state));
}

std::FILE* PendingFile::stream() const { return state_->stream; }

void PendingFile::write(std::string_view bytes) const {
  const bool complete = std::fwrite(bytes.data(), 1, bytes.size(), state_->stream) == bytes.size();
  if (!complete && state_->failure == 0) state_->failure = errno;
}

Result<void> PendingFile::commit() {
  State& state = *state_;
  const auto refused = [&](int failure) {
    return Error{fmt::format("cannot write '{}': {}", state.named, std::strerror(failure))};
  };
  if (state.failure != 0) return refused(state.failure);
  if (std::fflush(state.stream) != 0) return refused(errno);
  if (state.temporary.empty()) return {};
  if (std::rename(state.temporary.c_str(), state.path.c_str()) != 0) return refused(errno);
  forget(state.temporary.c_str());
  state.temporary.clear();
  return {};
}

Result<void> write_file(const std::string& path, std::string_view content) {
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  file.value().write(content);
  return file.value().commit();
}

void remove_pending_files() {
  for (auto& slot : pending_names) {
    if (const char* name = slot.load()) unlink(name);
  }
}

}  // namespace weft::tools
