/// usage: fuzz_seeds FOLDER
///
/// Writes the inputs of the targets saved_state, saved_model and run_state that are of what weft
/// itself saves: to be done again where a format has changed.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/saved_cloths.h"
#include "tools/program/run/run_state.h"

namespace weft::fuzz {
namespace {

void write(const std::filesystem::path& path, std::size_t first, std::span<const std::byte> rest) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.put(static_cast<char>(first));
  file.write(reinterpret_cast<const char*>(rest.data()), static_cast<std::streamsize>(rest.size()));
}

void write_all(const std::filesystem::path& folder) {
  for (std::size_t kind = 0; kind < kSavedCloths; ++kind) {
    const std::string name = "cloth_" + std::to_string(kind);
    const Bytes state = saved_cloth_on_its_way(kind).save_state();
    write(folder / "saved_state" / name, kind,
          std::span(state).subspan(kSealSize + kFingerprintSize));
    if (kind % 3 != 0) continue;
    write(folder / "saved_state" / (name + "_as_it_is"), kWhole + kind, state);
    const Bytes run = tools::bytes_of({.frame = 3, .dt = 0.01, .cloth = state});
    write(folder / "run_state" / name, kind, std::span(run).subspan(kSealSize));
    write(folder / "run_state" / (name + "_as_it_is"), kWhole + kind, run);
    const Bytes model = save_model(*saved_cloth(kind).model());
    write(folder / "saved_model" / name, 0, std::span(model).subspan(kSealSize));
    write(folder / "saved_model" / (name + "_as_it_is"), kWhole, model);
  }
}

}  // namespace
}  // namespace weft::fuzz

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("usage: fuzz_seeds FOLDER"), 2;
  weft::fuzz::write_all(argv[1]);
  return 0;
}
