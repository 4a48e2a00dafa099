// usage: saved_cloth save FILE | run FILE
//
// Saves a model, or steps the cloth of a saved one over a ball and prints the hash of every sixth
// frame, and the slowest, the mean and the fastest of them in ms. One source for two builds, whose
// models and hashes must be the same: by the machine's compiler, and by Emscripten.
#include <weft/mesh.h>
#include <weft/weft.h>

#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace {

template <class T>
T need(weft::Result<T> result) {
  if (!result) std::exit((std::puts(result.error().c_str()), 1));
  return std::move(result).value();
}

constexpr unsigned kSide = 40;

/// Of cotton, 1 m wide, some of its cells cut into triangles.
weft::MeshDescription sheet() {
  weft::MeshDescription mesh;
  for (unsigned i = 0; i < kSide * kSide; ++i) {
    mesh.positions.push_back(
        {i % kSide / (kSide - 1.), 0.4 + 0.003 * (i % 7), i / kSide / (kSide - 1.)});
    if (i < kSide || i % kSide == 0) continue;
    const unsigned a = i - kSide - 1, b = i - kSide, c = i, d = i - 1;
    if (i % 3 > 0) {
      mesh.corners.insert(mesh.corners.end(), {a, b, c, d});
      mesh.face_sizes.push_back(4);
    } else {
      mesh.corners.insert(mesh.corners.end(), {a, b, c, a, c, d});
      mesh.face_sizes.insert(mesh.face_sizes.end(), {3, 3});
    }
  }
  mesh.pins = {0, kSide - 1};
  mesh.material = need(weft::find_material("cotton"));
  return mesh;
}

int save(const char* path) {
  const auto model = need(weft::build_model(need(weft::cloth_from_mesh(sheet())).scene));
  const auto bytes = weft::save_model(*model);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return file.flush() ? 0 : 1;
}

int run(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto model = need(weft::load_model(std::as_bytes(std::span(bytes))));
  auto cloth = need(weft::Cloth::create(model, {.isa = weft::Isa::sse2}));
  need(cloth.add_body({.shape = need(weft::build_shape(weft::Ball{{0.5, 0, 0.5}, 0.25}))}));
  double all = 0, least = 1e9, most = 0;
  constexpr int kFrames = 60;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const auto begin = std::chrono::steady_clock::now();
    const weft::StepReport report = need(cloth.step(1 / 60.));
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    all += ms, least = std::min(least, ms), most = std::max(most, ms);
    if (frame % 6 > 0) continue;
    std::printf("%016" PRIx64 " %.*s\n", cloth.state_hash(),
                static_cast<int>(name(report.status).size()), name(report.status).data());
  }
  std::fprintf(stderr, "%zu particles: %.2f ms a frame, %.2f to %.2f\n", cloth.particle_count(),
               all / kFrames, least, most);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count == 3 && std::string(words[1]) == "save") return save(words[2]);
  if (count == 3 && std::string(words[1]) == "run") return run(words[2]);
  return std::puts("usage: saved_cloth save FILE | run FILE"), 2;
}
