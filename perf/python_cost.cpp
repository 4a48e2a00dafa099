// usage: weft_python_cost MODEL CLOTHS STEPS
//
// Steps so many cloths of a saved model in one thread, and prints the seconds of the processor that
// all steps but the first tenth took, and the state of the last cloth: what perf/python_cost.py
// holds Python's steps against.
#include <weft/weft.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string read_file(const char* name) {
  std::ifstream in(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void step(std::vector<weft::Cloth>& cloths, std::vector<weft::ClothStep>& steps) {
  if (cloths.size() > 1) return weft::step_all(steps);
  steps[0].result = cloths[0].step(steps[0].dt);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return std::puts("usage: weft_python_cost MODEL CLOTHS STEPS"), 2;
  const std::string bytes = read_file(arguments[1]);
  const auto model = weft::load_model(std::as_bytes(std::span(bytes)));
  if (!model) return std::puts(model.error().c_str()), 2;
  std::vector<weft::Cloth> cloths;
  for (int i = 0; i < std::atoi(arguments[2]); ++i) {
    cloths.push_back(weft::Cloth::create(model.value(), {}).value());
  }
  std::vector<weft::ClothStep> steps;
  for (weft::Cloth& cloth : cloths) steps.push_back({.cloth = &cloth, .dt = 0.01});
  const int number = std::atoi(arguments[3]);
  double start = 0;
  for (int i = 0; i < number; ++i) {
    if (i == number / 10) start = seconds();
    step(cloths, steps);
  }
  std::printf("%.9f %016llx\n", seconds() - start,
              static_cast<unsigned long long>(cloths.back().state_hash()));
}
