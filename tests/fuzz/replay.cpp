/// usage: weft_fuzz_replay TARGET FOLDER [CHANGED]
///
/// Gives a target all files of a folder and then, of each, so many inputs in which something is
/// changed by chance, the same on every machine. For builds without libFuzzer. A crash is a
/// failure; so is a target that none of the files takes all the way, as when a format has changed.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/checks.h"

// X(name) for each target, whose function is renamed to fuzz_<name>.
#define WEFT_FUZZ_TARGETS(X) \
  X(c_cloth)                 \
  X(c_mesh)                  \
  X(material)                \
  X(obj_file) X(options) X(pin_rule) X(run_state) X(saved_model) X(saved_state) X(scene_file)
#define WEFT_FUZZ_DECLARE(name) \
  extern "C" int WEFT_FUZZ_TARGET(name)(const std::uint8_t* data, std::size_t size);
WEFT_FUZZ_TARGETS(WEFT_FUZZ_DECLARE)

namespace {

using Input = std::vector<std::uint8_t>;
using Target = int (*)(const std::uint8_t*, std::size_t);

Target target_of(std::string_view name) {
#define WEFT_FUZZ_FIND(target) \
  if (name == #target) return WEFT_FUZZ_TARGET(target);
  WEFT_FUZZ_TARGETS(WEFT_FUZZ_FIND)
  return nullptr;
}

std::vector<Input> inputs_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().string());
  std::ranges::sort(names);
  std::vector<Input> inputs;
  for (const std::string& name : names) {
    std::ifstream file(name, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return inputs;
}

class Changes {
 public:
  explicit Changes(const std::vector<Input>& all) : all_(all) {}
  Input changed(Input input) {
    for (std::size_t i = 0; i <= below(4); ++i) change(input);
    return input;
  }

 private:
  std::size_t below(std::size_t bound) { return bits_() % bound; }

  void change(Input& input) {
    const std::size_t at = below(input.size() + 1);
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t more = 1 + below(8), there = std::min(more, input.size() - at);
    switch (below(6)) {
      case 0:
        input.insert(place, more, static_cast<std::uint8_t>(below(256)));
        break;
      case 1:
        input.erase(place, place + static_cast<std::ptrdiff_t>(there));
        break;
      case 2:
        input.resize(at);
        break;
      case 3:
        insert_part(input, place);
        break;
      default:
        if (there > 0) *place = new_byte(*place);
    }
  }
  std::uint8_t new_byte(std::uint8_t byte) {
    constexpr std::string_view kTelling = "0123456789-+.eE/:,[]{}\"\n \xff\x7f";
    if (below(3) == 0) return static_cast<std::uint8_t>(kTelling[below(kTelling.size())]);
    return below(2) == 0 ? static_cast<std::uint8_t>(byte ^ (1u << below(8)))
                         : static_cast<std::uint8_t>(below(256));
  }
  /// Of any of the files.
  void insert_part(Input& input, Input::iterator place) {
    const Input& other = all_[below(all_.size())];
    if (other.empty()) return;
    const std::size_t first = below(other.size()), size = 1 + below(other.size() - first);
    const auto from = other.begin() + static_cast<std::ptrdiff_t>(first);
    input.insert(place, from, from + static_cast<std::ptrdiff_t>(size));
  }

  const std::vector<Input>& all_;
  std::mt19937 bits_{1};
};

/// What the target has been given.
struct Last {
  const char* target = nullptr;
  const Input* input = nullptr;
} last;

/// What ended the target is left behind for whoever looks into it.
void keep_last(int) {
  const std::string name = std::string("last_input_of_") + last.target;
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(last.input->data()),
             static_cast<std::streamsize>(last.input->size()));
}

void give(Target target, const Input& input) {
  last.input = &input;
  target(input.data(), input.size());
}

}  // namespace

int main(int argc, char** argv) {
  const Target target = argc < 3 ? nullptr : target_of(argv[1]);
  if (target == nullptr) return std::puts("usage: weft_fuzz_replay TARGET FOLDER [CHANGED]"), 2;
  last.target = argv[1];
  std::signal(SIGABRT, keep_last);
  const std::vector<Input> inputs = inputs_in(argv[2]);
  const int changed_inputs = argc < 4 ? 0 : std::atoi(argv[3]);
  for (const Input& input : inputs) {
    give(target, input);
  }
  const std::size_t accepted = weft::fuzz::accepted_inputs();
  Changes changes(inputs);
  for (const Input& input : inputs) {
    for (int i = 0; i < changed_inputs; ++i) {
      const Input changed = changes.changed(input);
      give(target, changed);
    }
  }
  std::printf("%s: %zu files, of which %zu were accepted, and %d changed inputs of each\n", argv[1],
              inputs.size(), accepted, changed_inputs);
  return accepted > 0 ? 0 : 1;
}
