#include "tools/output_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "tools/pending_file.h"

namespace weft::tools {

Result<void> make_output_folder(const std::string& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) return Error{fmt::format("--out {}: {}", folder, problem.message())};
  const auto probe = PendingFile::open(std::filesystem::path(folder) / "probe");  // dropped
  return probe ? Result<void>{} : Result<void>{Error{probe.error()}};
}

Result<void> write_file(const std::filesystem::path& path, const std::string& content) {
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  file.value().write(content);
  return file.value().commit();
}

}  // namespace weft::tools
