/// weft_copy_bandwidth: how fast this machine copies memory, as JSON, for tools/profile.
#include <algorithm>
#include <cstdio>

#include "perf/bandwidth.h"

int main() {
  const weft::perf::Bandwidth bandwidth;
  const char* separator = "[";
  for (const auto& level : bandwidth.levels()) {
    const double size = static_cast<double>(level.size);
    std::printf("%s{\"name\": \"%.*s\", \"size\": %.0f, \"bytes_per_second\": %.6g}", separator,
                static_cast<int>(level.name.size()), level.name.data(), std::min(size, 1e15),
                level.bytes_per_second);
    separator = ",\n ";
  }
  return std::puts("]") < 0 ? 1 : 0;
}
