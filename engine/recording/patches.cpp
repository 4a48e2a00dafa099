#include "engine/recording/patches.h"

#include <algorithm>

#include "engine/validation.h"

namespace weft {
namespace {

using Bytes = std::span<const std::byte>;

Patch replacement(std::size_t at, std::size_t removed, Bytes put) {
  return {at, removed, {put.begin(), put.end()}};
}

/// All between what is the same at the beginning and at the end.
Patch middle(Bytes before, Bytes after) {
  const auto differs = std::mismatch(before.begin(), before.end(), after.begin(), after.end());
  const auto at = static_cast<std::size_t>(differs.first - before.begin());
  const std::size_t most = std::min(before.size(), after.size()) - at;
  std::size_t same = 0;  // at the end
  while (same < most && before[before.size() - same - 1] == after[after.size() - same - 1]) ++same;
  return replacement(at, before.size() - at - same, after.subspan(at, after.size() - at - same));
}

/// Patches of rows of one size. Equal bytes that take less than a patch of their own are in one.
std::vector<Patch> runs(Bytes before, Bytes after) {
  constexpr std::size_t kPatchBytes = 24;
  std::vector<Patch> all;
  for (std::size_t at = 0; at < before.size(); ++at) {
    if (before[at] == after[at]) continue;
    std::size_t last = at;  // that differs
    for (std::size_t i = at; i < before.size() && i - last < kPatchBytes; ++i)
      if (before[i] != after[i]) last = i;
    const std::size_t size = last + 1 - at;
    all.push_back(replacement(at, size, after.subspan(at, size)));
    at = last;
  }
  return all;
}

}  // namespace

std::vector<Patch> patches(Bytes before, Bytes after) {
  if (before.size() == after.size()) return runs(before, after);
  return {middle(before, after)};
}

Result<std::vector<std::byte>> patched(Bytes before, std::span<const Patch> patches) {
  std::vector<std::byte> after;
  std::size_t taken = 0;  // of what was before
  const auto take_until = [&](std::size_t end) {
    const Bytes kept = before.subspan(taken, end - taken);
    after.insert(after.end(), kept.begin(), kept.end());
    taken = end;
  };
  for (const Patch& patch : patches) {
    if (patch.at < taken || patch.at > before.size() || patch.removed > before.size() - patch.at)
      return refuse("patch", "is of other bytes", std::to_string(patch.at));
    take_until(patch.at);
    taken += patch.removed;
    after.insert(after.end(), patch.put.begin(), patch.put.end());
  }
  take_until(before.size());
  return after;
}

}  // namespace weft
