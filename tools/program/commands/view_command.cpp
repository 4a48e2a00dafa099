#include "tools/program/commands/view_command.h"

#include <fmt/format.h>

#include <memory>

#include "tools/program/files/pending_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/viewer/page.h"

namespace weft::tools {
namespace {

struct ViewOptions {
  std::vector<std::string> results;
  std::string out;
};

Result<void> write_page(const ViewOptions& options) {
  if (file_ending(options.out) != ".html")
    return Error{fmt::format("--out: '{}' does not end in .html", options.out)};
  std::vector<std::string> motions;
  for (const std::string& path : options.results) {
    auto read = read_motions(path);
    if (!read) return Error{read.error()};
    for (std::string& motion : read.value()) motions.push_back(std::move(motion));
  }
  if (motions.size() > kMostMotions) {
    return Error{fmt::format("a page shows {} results at most, and these files have {}",
                             kMostMotions, motions.size())};
  }
  const auto written = write_file(options.out, page_of(motions));
  if (!written) return Error{fmt::format("--out: {}", written.error())};
  return {};
}

}  // namespace

void add_view_command(CommandLine& line) {
  auto options = std::make_shared<ViewOptions>();
  Verb verb =
      line.add_verb("view", "Write a page that shows one result, or two side by side", [options] {
        const auto written = write_page(*options);
        return written ? kDone : refuse(written.error());
      });
  verb.several("result", options->results, "one or two files that --out wrote: .motion or .html");
  verb.required("--out", options->out, "the .html file to write");
}

}  // namespace weft::tools
